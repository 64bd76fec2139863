// Light on coarse lattices beside surfaces that stand in the smoke.
#include "medium/lattice/corners_seen.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/media.h"
#include "fixtures/plane_occluder.h"
#include "medium_lighting/levels/coarse_lighting.h"

namespace brisance {
namespace {

using namespace testing;

// 32 nodes along each axis.
Medium even_smoke() {
    Recipe r;
    r.box = cube(-16, 15);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    return make_medium(r);
}

// Light above a floor is not dimmed by the dark below it, and none of it gets there.
TEST(CornersSeen, KeepLightOnItsSideOfAFloor) {
    const Medium fine = even_smoke();
    const PlaneOccluder floor = plane_across(2, fine.local_of_node({0, 0, 3}).z + 0.3f * fine.spacing);
    for (const int level : {1, 2}) {
        const Medium coarse = medium_to_light(fine, level);
        std::vector<Rgb> light(coarse.lattice.node_count());
        const auto above = [&](const ivec3& node) { return node.z > 3; };
        for (std::size_t i = 0; i < light.size(); ++i)
            light[i] = Rgb(above(coarse.lattice.node(i) << level) ? 2.0f : 0.0f);
        const CornersSeen seen(fine, level, floor);
        const std::vector<Rgb> found = light_at_fine_nodes(coarse.lattice, light, level, fine.lattice, &seen),
                               blind = light_at_fine_nodes(coarse.lattice, light, level, fine.lattice);
        bool dimmed = false;
        for (std::size_t i = 0; i < found.size(); ++i)
            if (fine.extinction[i] > 0.0f) {
                const Rgb expected(above(fine.lattice.node(i)) ? 2.0f : 0.0f);
                dimmed = dimmed || std::abs(blind[i].x - expected.x) > 0.4f;
                ASSERT_NEAR(found[i].x, expected.x, 1e-5f) << fine.lattice.node(i).z;
            }
        EXPECT_TRUE(dimmed);
    }
}

// Of an even slab 32 voxels high the layers in the cell that the floor cuts spread a part over it: on the lattice twice
// as coarse, with the floor above an even node of a cell, half of the odd one above it; of four times as coarse, from
// the first to the last of the cell's nodes, 1/4 of the one below and 1/2 and 1/4 of those above the floor at its
// middle.
TEST(CornersSeen, CountWhatVoxelsPutBehindAFloor) {
    const Medium fine = even_smoke();
    const auto part = [&](float node, int level) {
        return part_beyond_surfaces(fine, level,
                                    plane_across(2, fine.local_of_node({0, 0, 0}).z + node * fine.spacing));
    };
    EXPECT_NEAR(part(0.5f, 1), 0.5 / 32.0, 1e-3);
    EXPECT_NEAR(part(1.5f, 1), 0.5 / 32.0, 1e-3);
    EXPECT_NEAR(part(1.5f, 2), (0.25 + 0.5 + 0.25) / 32.0, 1e-3);
    EXPECT_EQ(part(100.0f, 2), 0.0);
}

}  // namespace
}  // namespace brisance
