// All frames of a sequence are solved on the lattices of its largest file.
#include <gtest/gtest.h>

#include "fixtures/media.h"
#include "make_vdb.h"
#include "render/choice/sequence_levels.h"
#include "render/render_frame.h"
#include "temp_folder.h"

namespace brisance {
namespace {

using namespace testing;

void write_smoke(const std::filesystem::path& file, int half_width) {
    TestGrid grid;
    grid.name = "density";
    grid.world_from_index = cubic(0.1);
    grid.voxels = fill_box(ivec3(-half_width), ivec3(half_width), [](const ivec3&) { return 1.0; });
    write_vdb(file, {grid});
}

TEST(SequenceLevels, AreThoseOfTheGivenFrameAndWhatTheShotStatesStays) {
    const TempFolder folder;
    write_smoke(folder / "a.0001.vdb", 4);
    write_smoke(folder / "a.0002.vdb", 40);
    Shot shot;
    shot.volume.file = (folder / "a.####.vdb").string();
    Progress silent;
    const Shot small = with_levels_of(shot, folder / "a.0001.vdb", 1, silent);
    const Shot large = with_levels_of(shot, folder / "a.0002.vdb", 2, silent);
    EXPECT_GT(large.lighting.levels, small.lighting.levels);
    EXPECT_FALSE(leaves_levels_open(large));
    shot.lighting.levels = 3;
    EXPECT_EQ(with_levels_of(shot, folder / "a.0002.vdb", 2, silent).lighting.levels, 3);
    EXPECT_EQ(large.scattering.lattice_level, -1) << "it changes gradually from frame to frame";
    shot.lighting.lattice_level = 0;
    EXPECT_TRUE(leaves_levels_open(shot));
    shot.lighting.smoke_lattice_level = 0;
    EXPECT_FALSE(leaves_levels_open(shot));
    shot.lighting.lattice_level = -1;
    shot.method = RenderMethod::Path;
    EXPECT_FALSE(leaves_levels_open(shot));
}

// Thin smoke is lit on wider voxels; not where a floor through nine layers of it would have a part of their light
// beyond.
TEST(SequenceLevels, KnowTheFloorInTheSmoke) {
    const TempFolder folder;
    write_smoke(folder / "a.0001.vdb", 4);
    write_smoke(folder / "b.0001.vdb", 40);
    const auto level = [&](const char* volume, bool floor) {
        Shot shot;
        shot.volume.file = (folder / volume).string();
        shot.medium.smoke.extinction_per_metre = 0.1f;
        if (floor) {
            QuickQuad quad;
            quad.corners = {dvec3(-10, -10, 0.05), dvec3(10, -10, 0.05), dvec3(10, 10, 0.05), dvec3(-10, 10, 0.05)};
            shot.scene.quads.push_back(quad);
        }
        Progress silent;
        return with_levels_of(shot, folder / volume, 1, silent).lighting.lattice_level;
    };
    EXPECT_EQ(level("a.0001.vdb", false), 1);
    EXPECT_EQ(level("b.0001.vdb", false), 1);
    EXPECT_EQ(level("a.0001.vdb", true), 0);
    EXPECT_EQ(level("b.0001.vdb", true), 1);
}

TEST(SequenceLevels, HoldTheMeanEscapeProbabilityWhereItDecides) {
    const TempFolder folder;
    write_smoke(folder / "a.0001.vdb", 6);
    Shot shot;
    shot.volume.file = (folder / "a.####.vdb").string();
    shot.lighting.levels = 3;
    shot.lighting.lattice_level = shot.lighting.smoke_lattice_level = 0;
    EXPECT_FALSE(leaves_levels_open(shot));
    shot.medium.smoke.mean_cosine = 0.5f;
    shot.medium.smoke.extinction_per_metre = 1.0f;
    EXPECT_TRUE(leaves_levels_open(shot));
    Listener listener;
    const Shot kept = with_levels_of(shot, folder / "a.0001.vdb", 1, listener);
    EXPECT_GT(kept.scattering.escape, 0.4f);
    EXPECT_LT(kept.scattering.escape, 0.9f);
    EXPECT_FALSE(leaves_levels_open(kept));
    ASSERT_FALSE(listener.notices.empty());
    EXPECT_NE(listener.notices.back().find("scattering.escape="), std::string::npos) << listener.notices.back();
    shot.scattering.escape = 0.25f;
    EXPECT_EQ(with_levels_of(shot, folder / "a.0001.vdb", 1, listener).scattering.escape, 0.25f);
}

}  // namespace
}  // namespace brisance
