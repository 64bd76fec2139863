// Grids find their roles by name, preset or request, and every choice can be explained.
#include <gtest/gtest.h>

#include "temp_folder.h"
#include "volume/mapping.h"
#include "volume/vector_parts.h"
#include "volume/velocity_mapping.h"

namespace brisance {
namespace {

GridInfo grid(const std::string& name, const std::string& type = "float", int index = 0) {
    GridInfo info;
    info.name = name;
    info.index = index;
    info.value_type = type;
    info.usable = true;
    return info;
}

GridInfo level_set(const std::string& name) {
    GridInfo info = grid(name);
    info.usable = false;
    info.why_unusable = "is a level set; convert it";
    return info;
}

std::string all_notes(const GridMapping& mapping) {
    std::string text;
    for (const std::string& note : mapping.notes)
        text += note + "\n";
    return text;
}

GridMapping map(const std::vector<GridInfo>& grids, const VolumeSettings& settings = {}) {
    return map_grids(grids, settings, "file.vdb");
}

TEST(Mapping, KnownNamesMapThemselvesWhateverTheirCase) {
    const GridMapping mapping = map({grid("Density"), grid("FLAMES"), grid("Temp"), grid("Cd", "vec3s")});
    EXPECT_EQ(mapping.density->name, "Density");
    EXPECT_EQ(mapping.flame->name, "FLAMES");
    EXPECT_EQ(mapping.temperature->name, "Temp");
    EXPECT_EQ(mapping.colour->name, "Cd");
    EXPECT_EQ(mapping.describe(),
              "density <- \"Density\", temperature <- \"Temp\", flame <- \"FLAMES\", colour <- \"Cd\"");
}

TEST(Mapping, TheFirstNameInTheTableWinsNotTheFirstGrid) {
    const GridMapping mapping = map({grid("fuel"), grid("smoke"), grid("flame"), grid("density")});
    EXPECT_EQ(mapping.density->name, "density");
    EXPECT_EQ(mapping.flame->name, "flame");
    EXPECT_TRUE(contains(all_notes(mapping), "unused grids: \"fuel\", \"smoke\""));
}

TEST(Mapping, HeatIsOnlyMappedUnderAPreset) {
    const std::vector<GridInfo> grids = {grid("density"), grid("heat")};
    const GridMapping automatic = map(grids);
    EXPECT_FALSE(automatic.flame || automatic.temperature);
    EXPECT_TRUE(contains(all_notes(automatic), "heat is burn intensity in Houdini"));
    VolumeSettings settings;
    settings.preset = MappingPreset::Houdini;
    EXPECT_EQ(map(grids, settings).flame->name, "heat");
    settings.preset = MappingPreset::Mantaflow;
    EXPECT_EQ(map(grids, settings).temperature->name, "heat");
    EXPECT_TRUE(contains(map(grids, settings).temperature->reason, "preset mantaflow"));
    EXPECT_EQ(failure_of([&] { map({grid("heat")}); }).code, ExitCode::BadData) << "nor as the only grid";
}

TEST(Mapping, TheShotsWordIsFinal) {
    const std::vector<GridInfo> grids = {grid("density"), grid("bob"), grid("flame")};
    VolumeSettings settings;
    settings.grids.density = "bob";
    settings.grids.flame = "";
    const GridMapping mapping = map(grids, settings);
    EXPECT_EQ(mapping.density->name, "bob");
    EXPECT_EQ(mapping.density->reason, "named by the shot");
    EXPECT_FALSE(mapping.flame) << "an empty name selects no grid";
}

TEST(Mapping, AnAbsentGridIsAnErrorThatNamesThoseThatAreThere) {
    VolumeSettings settings;
    settings.grids.density = "Density";
    const Failure failure = failure_of([&] { map({grid("density"), grid("flame"), grid("")}, settings); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "\"density\", \"flame\", \"[0]\" (unnamed)")) << failure.message;
}

TEST(Mapping, AnUnusableGridIsAnErrorThatSaysWhy) {
    VolumeSettings settings;
    settings.grids.density = "sdf";
    const Failure failure = failure_of([&] { map({level_set("sdf"), grid("density")}, settings); });
    EXPECT_TRUE(contains(failure.message, "level set; convert it")) << failure.message;
}

TEST(Mapping, GridsOfOneNameAreChosenByIndexAndMentioned) {
    const std::vector<GridInfo> grids = {grid("density", "float", 0), grid("density", "float", 1)};
    const GridMapping automatic = map(grids);
    EXPECT_EQ(automatic.density->index, 0);
    EXPECT_TRUE(contains(all_notes(automatic), "name \"density[1]\" in the shot to pick another"));
    VolumeSettings settings;
    settings.grids.density = "density[1]";
    EXPECT_EQ(map(grids, settings).density->index, 1);
    EXPECT_TRUE(contains(map(grids, settings).describe(), "density <- \"density[1]\""));
}

TEST(Mapping, BracketsMayBelongToTheName) {
    VolumeSettings settings;
    settings.grids.density = "smoke[7]";
    EXPECT_EQ(map({grid("smoke[7]"), grid("x")}, settings).density->name, "smoke[7]");
}

TEST(Mapping, AVectorIsNoDensityAndAScalarNoColour) {
    const GridMapping mapping = map({grid("density", "vec3s"), grid("flame"), grid("color")});
    EXPECT_FALSE(mapping.density || mapping.colour);
    EXPECT_TRUE(contains(all_notes(mapping), "three values per voxel"));
    EXPECT_TRUE(contains(all_notes(mapping), "a colour needs three"));
}

TEST(Mapping, WholeNumbersMarkCellsAndAreNoAmountUnlessTheShotSaysSo) {
    const std::vector<GridInfo> grids = {grid("flags", "int32"), grid("density", "int32"), grid("smoke")};
    const GridMapping mapping = map(grids);
    EXPECT_EQ(mapping.density->name, "smoke");
    EXPECT_TRUE(contains(all_notes(mapping), "whole numbers"));
    EXPECT_EQ(failure_of([&] { map({grid("flags", "int32")}); }).code, ExitCode::BadData);
    EXPECT_EQ(failure_of([&] { map({grid("flags")}); }).code, ExitCode::BadData);
    VolumeSettings settings;
    settings.grids.density = "density";
    EXPECT_EQ(map(grids, settings).density->name, "density");
}

TEST(Mapping, ThreeScalarGridsAreOneColour) {
    const std::vector<GridInfo> grids = {grid("density"), grid("color_b"), grid("Color_R"), grid("color_g")};
    const GridMapping mapping = map(grids);
    ASSERT_EQ(mapping.colour_parts.size(), 3u);
    EXPECT_EQ(mapping.colour_parts[0].name, "Color_R");
    EXPECT_EQ(mapping.colour_parts[2].name, "color_b");
    EXPECT_TRUE(contains(mapping.describe(), "colour <- \"Color_R\" + \"color_g\" + \"color_b\""));
    EXPECT_FALSE(contains(all_notes(mapping), "unused"));
    EXPECT_TRUE(map({grid("density"), grid("Cd.x"), grid("Cd.y")}).colour_parts.empty()) << "a part is missing";
    EXPECT_TRUE(
        map({grid("Cd", "vec3s"), grid("Cd.x"), grid("Cd.y"), grid("Cd.z"), grid("density")}).colour_parts.empty());
    VolumeSettings none;
    none.grids.colour = "";
    EXPECT_TRUE(map(grids, none).colour_parts.empty());
}

BlockGrid one_block(const ivec3& origin, float value) {
    BlockGrid block;
    block.block_origin = {origin};
    block.values.assign(512, value);
    return block;
}

TEST(Mapping, PartsOfAColourAreJoinedVoxelByVoxel) {
    const BlockGrid joined = join_vector_parts(
        {one_block(ivec3(0), 1.0f), one_block(ivec3(0), 2.0f), one_block(ivec3(8, 0, 0), 3.0f)}, "a.vdb");
    ASSERT_EQ(joined.block_origin.size(), 2u);
    EXPECT_EQ(joined.channels, 3);
    for (std::size_t v = 0; v < 512; ++v) {
        EXPECT_EQ(joined.values[3 * v], 1.0f);
        EXPECT_EQ(joined.values[3 * v + 1], 2.0f);
        EXPECT_EQ(joined.values[3 * v + 2], 0.0f);
        EXPECT_EQ(joined.values[3 * (512 + v) + 2], 3.0f);
    }
    BlockGrid elsewhere = one_block(ivec3(0), 1.0f);
    elsewhere.info.world_from_index[3][0] = 0.5;
    const Failure failure = failure_of([&] {
        join_vector_parts({one_block(ivec3(0), 1.0f), elsewhere, one_block(ivec3(0), 1.0f)}, "a.vdb");
    });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "a.vdb: grids"));
}

TEST(Mapping, TheOnlyScalarGridIsDensityWhateverItsName) {
    EXPECT_EQ(map({grid("bob"), grid("v", "vec3s"), level_set("surface")}).density->name, "bob");
    const GridMapping unnamed = map({grid("")});
    EXPECT_EQ(unnamed.density->name, "");
    EXPECT_TRUE(contains(all_notes(unnamed), "\"[0]\" (unnamed), the only usable scalar grid"));
    VolumeSettings settings;
    settings.grids.density = "[0]";
    EXPECT_EQ(map({grid("")}, settings).density->name, "");
}

TEST(Mapping, NothingToRenderListsEveryGridAndWhyNot) {
    const Failure failure = failure_of([&] { map({level_set("sdf"), grid("vel", "vec3s"), grid("a"), grid("b")}); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    for (const char* words :
         {"\"sdf\" is a level set", "\"vel\" holds three values", "\"a\" has no known name", "\"b\""})
        EXPECT_TRUE(contains(failure.message, words)) << failure.message;
}

VelocityMapping velocity_of(const std::vector<GridInfo>& grids, const GridRoles& roles = {}) {
    return map_velocity(grids, roles, "file.vdb");
}

TEST(VelocityMapping, KnowsVectorsAndThreeScalarsByName) {
    EXPECT_EQ(velocity_of({grid("density"), grid("Vel", "vec3s")}).describe(), "\"Vel\"");
    EXPECT_EQ(velocity_of({grid("vel_y"), grid("vel_z"), grid("VEL_X")}).describe(), "\"VEL_X\", \"vel_y\", \"vel_z\"");
    EXPECT_TRUE(velocity_of({grid("vel_y"), grid("vel_z")}).grids.empty()) << "two are none";
    EXPECT_TRUE(velocity_of({grid("velocity")}).grids.empty()) << "one value per voxel is a speed";
    EXPECT_TRUE(contains(velocity_of({grid("density")}).why_none, "volume.grids.velocity"));
}

TEST(VelocityMapping, TakesWhatTheShotNamesAndRefusesWhatIsNone) {
    const std::vector<GridInfo> grids = {grid("a", "vec3s"), grid("b", "vec3s", 1), grid("u"), grid("v"),
                                         grid("w"),          level_set("l")};
    GridRoles roles;
    roles.velocity = {"b[1]"};
    EXPECT_EQ(velocity_of(grids, roles).grids[0].index, 1);
    roles.velocity = {"u", "v", "w"};
    EXPECT_EQ(velocity_of(grids, roles).grids.size(), 3u);
    roles.velocity = std::vector<std::string>{};
    EXPECT_TRUE(velocity_of(grids, roles).grids.empty());
    const std::vector<std::vector<std::string>> wrong = {{"none"}, {"u"}, {"l"}, {"a", "u", "v"}};
    for (const std::vector<std::string>& names : wrong) {
        roles.velocity = names;
        const Failure failure = failure_of([&] { velocity_of(grids, roles); });
        EXPECT_EQ(failure.code, ExitCode::BadData);
        EXPECT_TRUE(contains(failure.message, "name a vector grid")) << failure.message;
    }
}

TEST(VelocityMapping, AVelocityIsNotCalledUnused) {
    EXPECT_FALSE(contains(all_notes(map({grid("density"), grid("velocity", "vec3s")})), "velocity"));
}

}  // namespace
}  // namespace brisance
