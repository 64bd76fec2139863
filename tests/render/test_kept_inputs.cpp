// What frames of a sequence hand on to each other changes no bit of them.
#include <gtest/gtest.h>

#include <algorithm>

#include "make_vdb.h"
#include "render/input/kept_inputs.h"
#include "render/render_frame.h"
#include "shot/read_shot.h"
#include "temp_folder.h"

namespace brisance::test_kept_inputs {
namespace {

constexpr int kFrames = 3;

// A triangle with corners 0, x and y.
constexpr const char* kTriangle = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                   "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36,
        "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

// Smoke with fire that grows, a triangle from a file beside it, a lamp and a sky.
class SmallSequence {
public:
    SmallSequence() {
        for (int frame = 1; frame <= kFrames; ++frame) {
            TestGrid density, flame;
            flame.name = "flame";
            density.world_from_index = flame.world_from_index = dmat4(dmat3(0.25));
            density.voxels = fill_box(ivec3(-4), ivec3(3 + frame), [](const ivec3&) { return 1.0; });
            flame.voxels = fill_box(ivec3(-1), ivec3(frame), [&](const ivec3&) { return 0.5 * frame; });
            write_vdb(volume(frame), {density, flame});
        }
        write_bytes(folder_ / "set.gltf", kTriangle);
    }
    std::filesystem::path volume(int frame) const { return folder_ / ("smoke_" + std::to_string(frame) + ".vdb"); }

    Shot shot() const {
        return parse_shot(R"({"volume": {"file": "smoke_#.vdb"},
            "fire": {"model": "flame", "strength": 5},
            "camera": {"eye": [0, -6, 1], "target": [0, 0, 0], "width": 24, "height": 16, "samples_per_axis": 1},
            "scattering": {"bounces": 1},
            "scene": {"files": [{"file": "set.gltf"}],
                      "lights": [{"kind": "point", "position": [1, -2, 2], "power": [3, 3, 3]},
                                 {"kind": "environment", "power": [0.1, 0.1, 0.2]}]}})",
                          "a.json", folder_.path(), {});
    }

    // All frames, one after the other.
    std::vector<RenderedFrame> render(bool keeps) const {
        Progress silent;
        KeptInputs kept;
        std::vector<RenderedFrame> frames;
        for (int frame = 1; frame <= kFrames; ++frame) {
            kept.next = frame < kFrames ? std::optional(FrameFile{frame + 1, volume(frame + 1)}) : std::nullopt;
            frames.push_back(render_frame(shot(), volume(frame), frame, silent, {}, keeps ? &kept : nullptr));
        }
        return frames;
    }

private:
    TempFolder folder_;
};

const StageCost& stage_of(const RenderedFrame& frame, const std::string& name) {
    return *std::ranges::find(frame.statistics.stages, name, &StageCost::name);
}

TEST(KeptInputs, ChangeNoBitOfAnyFrame) {
    const SmallSequence sequence;
    const std::vector<RenderedFrame> alone = sequence.render(false), together = sequence.render(true);
    for (std::size_t i = 0; i < alone.size(); ++i) {
        ASSERT_EQ(together[i].image.layers.size(), alone[i].image.layers.size());
        for (std::size_t k = 0; k < alone[i].image.layers.size(); ++k)
            EXPECT_EQ(together[i].image.layers[k].pixels, alone[i].image.layers[k].pixels)
                << "frame " << i + 1 << ", layer " << alone[i].image.layers[k].name;
        EXPECT_EQ(together[i].statistics.notices, alone[i].statistics.notices);
        EXPECT_EQ(together[i].statistics.warnings, alone[i].statistics.warnings);
        EXPECT_EQ(stage_of(together[i], "reading").detail.contains("seconds_ahead"), i > 0);
        EXPECT_EQ(stage_of(together[i], "surfaces").detail.contains("kept"), i > 0);
        EXPECT_FALSE(stage_of(alone[i], "reading").detail.contains("seconds_ahead"));
    }
}

TEST(KeptInputs, ASetHoldsWhereItStandsStill) {
    KeptSet set;
    EXPECT_FALSE(set.holds_at(0.0, dvec3(0.0))) << "there is none";
    set.surroundings = std::make_shared<Surroundings>(Scene{}, std::vector<LightSettings>{});
    EXPECT_TRUE(set.holds_at(2.0, dvec3(0.0)));
    EXPECT_FALSE(set.holds_at(2.0, dvec3(0.0, 1.0, 0.0))) << "another local space";
    set.animated = true;
    EXPECT_TRUE(set.holds_at(0.0, dvec3(0.0)));
    EXPECT_FALSE(set.holds_at(2.0, dvec3(0.0))) << "it moves";
}

TEST(KeptInputs, ReadingAheadTakesNoMemoryThatLightingNeeds) {
    EXPECT_FALSE(memory_allows(std::nullopt, 1, 1)) << "not known";
    EXPECT_TRUE(memory_allows(30, 20, 10));
    EXPECT_FALSE(memory_allows(29, 20, 10));
    EXPECT_FALSE(memory_allows(10, 20, 0));
}

}  // namespace
}  // namespace brisance::test_kept_inputs
