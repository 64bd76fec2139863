// Everything published about shots agrees with the reader: the schema, the shots that come with the program, and shots
// written back.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "shot/keys/keys.h"
#include "shot/write_shot.h"
#include "shot_errors.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;
using testing::parsed;
using testing::with;

const fs::path kShots = fs::path(BRISANCE_SOURCE) / "shots";

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST(Schema, TheCommittedFileIsTheOneThatIsPrinted) {
    EXPECT_EQ(contents(kShots / "shot.schema.json"), shot_schema())
        << "renew it: build/release/bin/brisance schema > shots/shot.schema.json";
}

TEST(Schema, KnowsEveryKeyAndForbidsOthers) {
    const Json schema = Json::parse(shot_schema());
    for (const Key& key : shot_keys()) {
        const Json* object = &schema;
        std::size_t begin = 0;
        while (begin != std::string::npos) {
            EXPECT_EQ((*object)["additionalProperties"], false) << key.path;
            const std::size_t point = key.path.find('.', begin);
            const std::string part = key.path.substr(begin, point == std::string::npos ? point : point - begin);
            ASSERT_TRUE((*object)["properties"].contains(part)) << key.path;
            object = &(*object)["properties"][part];
            begin = point == std::string::npos ? point : point + 1;
        }
        EXPECT_EQ((*object)["description"], key.help);
    }
}

TEST(Schema, BoundsAreThoseOfTheReader) {
    const Json schema = Json::parse(shot_schema());
    const Json& width = schema["properties"]["camera"]["properties"]["width"];
    EXPECT_EQ(testing::message_of_overrides({"camera.width=" + width["maximum"].dump()}), "");
    EXPECT_NE(testing::message_of_overrides({"camera.width=" + std::to_string(width["maximum"].get<int>() + 1)}), "");
    const Json& fov = schema["properties"]["camera"]["properties"]["vertical_fov_degrees"];
    EXPECT_NE(testing::message_of_overrides({"camera.vertical_fov_degrees=" + fov["exclusiveMaximum"].dump()}), "");
}

TEST(Schema, ShotsThatComeWithTheProgramAreRead) {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(kShots)) {
        if (entry.path().extension() != ".json" || entry.path().filename() == "shot.schema.json")
            continue;
        ++count;
        EXPECT_NO_THROW({
            const Shot shot = read_shot(entry.path());
            EXPECT_FALSE(shot.volume.file.empty() && shot.volumes.empty() && shot.scene.empty());
        }) << entry.path();
    }
    EXPECT_GT(count, 0);
}

// Settings far from the defaults, one shot with each kind of camera.
std::vector<Shot> unusual_shots() {
    const std::vector<std::string> common = {"name=\"a \\\"quoted\\\" n\u00e4me\"",
                                             "volume.preset=houdini",
                                             "volume.grids.density=\"density[2]\"",
                                             "volume.grids.colour=\"\"",
                                             "smoke.albedo=[0.1,0.2,0.3]",
                                             "smoke.mean_cosine=0.7",
                                             "fire.model=blackbody_normalized",
                                             "fire.ramp=[[0,0],[1.5,[1,0.5,0.25]]]",
                                             "fire.modulate_by_flame=true",
                                             "fire.temperature_in=[0,2.95]",
                                             "colour_role=emission",
                                             "camera.samples_per_axis=3",
                                             "camera.edge_refinement=2",
                                             "lighting.levels=7",
                                             "lighting.memory_limit_mebibytes=100.5",
                                             "lighting.shadows=none",
                                             "scattering.bounces=0",
                                             "scattering.lattice_level=0",
                                             "scattering.escape=0.3",
                                             "scattering.solver=radiance_cascades",
                                             "scattering.cascade_side=4",
                                             "scattering.flux_limiter=false",
                                             "output.exposure_stops=0",
                                             "output.layers.bounces=true",
                                             "output.frames_per_second=23.976"};
    std::vector<std::string> look_at = common, matrix = common;
    look_at.insert(look_at.end(), {"camera.eye=[1,2,3]", "camera.target=[0.1,0.2,0.30000000000000004]"});
    matrix.emplace_back("camera.world_from_camera=[1,0,0,4, 0,0,-1,5, 0,1,0,6, 0,0,0,1]");
    return {with({}), with(common), with(look_at), with(matrix)};
}

TEST(WriteShot, WhatIsWrittenReadsBackTheSame) {
    for (const Shot& shot : unusual_shots()) {
        const Shot back = parsed(to_json(shot));
        EXPECT_EQ(to_json(back), to_json(shot));
        EXPECT_EQ(settings_hash(back), settings_hash(shot));
        EXPECT_EQ(back.camera_given, shot.camera_given);
        EXPECT_EQ(back.exposure_given, shot.exposure_given);
        EXPECT_EQ(back.lighting.memory_limit_bytes, shot.lighting.memory_limit_bytes);
        EXPECT_EQ(back.camera.target, shot.camera.target);
    }
}

TEST(WriteShot, AShotOfSurfacesAloneReadsBackTheSame) {
    Shot alone;
    alone.scene.quads.emplace_back();
    const std::string written = to_json(alone);
    EXPECT_EQ(written.find("\"file\": \"\""), std::string::npos);
    EXPECT_EQ(to_json(parsed(written)), written);
}

TEST(WriteShot, HashesDifferWithSettingsAndNotWithPlaces) {
    const std::string hash = settings_hash(with({}));
    EXPECT_EQ(hash.size(), 16u);
    EXPECT_EQ(settings_hash(with({"output.path=elsewhere/a.exr"})), hash);
    for (const char* setting : {"smoke.albedo=0.81", "volume.file=b.vdb", "lighting.alpha=2.5",
                                "output.exposure_stops=0", "camera.width=1281", "volume.grids.flame=\"\""})
        EXPECT_NE(settings_hash(with({setting})), hash) << setting;
}

TEST(WriteShot, TextForPeopleNamesEveryKey) {
    const std::string text = shot_keys_text();
    for (const Key& key : shot_keys())
        EXPECT_NE(text.find(key.path + "\n    " + key.help), std::string::npos) << key.path;
}

}  // namespace
}  // namespace brisance
