// Virtual lights of a sequence: decided by frame numbers and files, never by which frames are rendered.
#include <gtest/gtest.h>

#include "make_vdb.h"
#include "render/light_windows.h"
#include "render/render_frame.h"
#include "shot/read_shot.h"
#include "temp_folder.h"

namespace brisance {
namespace {

TEST(LightWindows, SharesAddUpAndChangeSteadily) {
    constexpr int kWidth = 8;
    const auto share_of = [](int frame, int number) {
        for (const LightWindow& window : light_windows(frame, kWidth))
            if (window.number == number)
                return window.share;
        return 0.0;
    };
    for (int frame = -20; frame < 20; ++frame) {
        double sum = 0.0;
        for (int number = -4; number <= 4; ++number) {
            sum += share_of(frame, number);
            EXPECT_LE(std::abs(share_of(frame + 1, number) - share_of(frame, number)), 1.0 / kWidth + 1e-12);
        }
        EXPECT_NEAR(sum, 1.0, 1e-12);
    }
    EXPECT_EQ(light_windows(16, kWidth).size(), 1u);
    EXPECT_EQ(light_windows(-3, 1).front().number, -3);
}

constexpr int kLast = 5;

// Smoke with fire that grows between two walls.
class SequenceInASet {
public:
    SequenceInASet() {
        for (int frame = 1; frame <= kLast; ++frame) {
            TestGrid density, flame;
            flame.name = "flame";
            density.world_from_index = flame.world_from_index = dmat4(dmat3(0.25));
            density.voxels = fill_box(ivec3(-4), ivec3(2 + frame), [](const ivec3&) { return 1.0; });
            flame.voxels = fill_box(ivec3(-1), ivec3(frame), [&](const ivec3&) { return 0.5 * frame; });
            write_vdb(volume(frame), {density, flame});
        }
    }
    std::filesystem::path volume(int frame) const { return folder_ / ("smoke_" + std::to_string(frame) + ".vdb"); }

    Shot shot() const {
        return parse_shot(R"({"volume": {"file": "smoke_#.vdb"},
            "fire": {"model": "flame", "strength": 5},
            "camera": {"eye": [0, -6, 1], "target": [0, 0, 0], "width": 24, "height": 16, "samples_per_axis": 1},
            "shutter": {"length": 0},
            "virtual_lights": {"count": 200, "photons": 20000, "window": 2},
            "lighting": {"levels": 3}, "scattering": {"lattice_level": 0},
            "scene": {"quads": [
                {"corners": [[-4, 3, -3], [4, 3, -3], [4, 3, 3], [-4, 3, 3]], "colour": 0.7},
                {"corners": [[-4, -7, -2], [4, -7, -2], [4, 3, -2], [-4, 3, -2]], "colour": 0.5}]}})",
                          "a.json", folder_.path(), {});
    }

    FrameInput input(int frame) const {
        Progress silent;
        Statistics unused;
        return load_frame(shot(), volume(frame), frame, unused, silent);
    }
    std::vector<SharedPositions> positions(int frame, KeptInputs* kept = nullptr, Progress* to = nullptr) const {
        Progress silent;
        Statistics unused;
        return shared_positions(shot(), frame, input(frame), kept, unused, to ? *to : silent);
    }

    TempFolder folder_;
};

TEST(LightWindows, FramesOfAWindowSharePositions) {
    const SequenceInASet sequence;
    const std::vector<SharedPositions> three = sequence.positions(3), five = sequence.positions(5);
    ASSERT_EQ(three.size(), 2u);
    ASSERT_EQ(five.size(), 2u);
    EXPECT_GT(three[1].lights->deposits.size(), 50u);
    EXPECT_EQ(to_bytes(*three[1].lights), to_bytes(*five[0].lights)) << "window 2 around frame 4";
    EXPECT_NE(to_bytes(*three[0].lights), to_bytes(*three[1].lights));
    EXPECT_EQ(sequence.positions(4).size(), 1u);
}

TEST(LightWindows, KeptPositionsAreThoseOfAFrameByItself) {
    const SequenceInASet sequence;
    KeptInputs kept;
    for (int frame = 1; frame <= kLast; ++frame) {
        const std::vector<SharedPositions> together = sequence.positions(frame, &kept),
                                           alone = sequence.positions(frame);
        ASSERT_EQ(together.size(), alone.size());
        for (std::size_t i = 0; i < alone.size(); ++i)
            EXPECT_EQ(to_bytes(*together[i].lights), to_bytes(*alone[i].lights)) << frame;
        EXPECT_LE(kept.light_windows.size(), 2u) << "those of earlier frames are let go";
    }
}

class Warnings : public Progress {
public:
    void warning(const std::string& code, const std::string&) override { codes.push_back(code); }
    std::vector<std::string> codes;
};

TEST(LightWindows, AWindowWithoutItsFileIsLeftOut) {
    const SequenceInASet sequence;
    write_bytes(sequence.volume(4), "no volume");
    Warnings warnings;
    const std::vector<SharedPositions> three = sequence.positions(3, nullptr, &warnings);
    ASSERT_EQ(three.size(), 1u);
    EXPECT_EQ(three[0].share, 1.0);
    EXPECT_EQ(warnings.codes, std::vector<std::string>{"light-window"});
}

TEST(LightWindows, AStillPlacesItsOwn) {
    const SequenceInASet sequence;
    Shot shot = sequence.shot();
    shot.volume.file = "smoke_3.vdb";
    EXPECT_FALSE(may_share_lights(shot));
    shot = sequence.shot();
    shot.virtual_lights.window = 0;
    EXPECT_FALSE(may_share_lights(shot));
}

// The light between surfaces, and on smoke.
TEST(LightWindows, AFrameByItselfHasTheBitsOfTheSequence) {
    const SequenceInASet sequence;
    Progress silent;
    KeptInputs kept;
    for (int frame = 3; frame <= 4; ++frame) {
        const Image together = render_frame(sequence.shot(), sequence.volume(frame), frame, silent, {}, &kept).image,
                    alone = render_frame(sequence.shot(), sequence.volume(frame), frame, silent).image;
        for (std::size_t k = 0; k < alone.layers.size(); ++k)
            EXPECT_EQ(together.layers[k].pixels, alone.layers[k].pixels) << frame << " " << alone.layers[k].name;
    }
}

}  // namespace
}  // namespace brisance
