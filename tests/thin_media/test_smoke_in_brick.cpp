// Walls that part the smoke of a brick, or stand at its rim.
#include <gtest/gtest.h>

#include "fixtures/media.h"
#include "fixtures/plane_occluder.h"
#include "thin_media/smoke_in_brick.h"

namespace brisance {
namespace {

using namespace testing;

constexpr float kSpacing = 0.05f;

// Fills its only brick but for two layers at the low end of x.
Medium smoke() {
    Recipe recipe;
    recipe.box = {ivec3(0), ivec3(7)};
    recipe.world_from_index = cubic(kSpacing);
    recipe.density = [](const ivec3& n) { return n.x < 2 ? 0.0f : 1.0f; };
    recipe.settings = black_smoke();
    recipe.settings.smoke.extinction_per_metre = 1.0f;
    return make_medium(recipe);
}

class PartedSmoke : public ::testing::Test {
protected:
    // A wall `nodes` from the brick's first node.
    std::optional<BrickPart> with_wall(int axis, float nodes) const {
        const vec3 first = medium_.local_of_node(medium_.lattice.first_node(brick_));
        return unparted_smoke(plane_across(axis, first[axis] + nodes * kSpacing), medium_, brick_);
    }
    Medium medium_ = smoke();
    std::size_t brick_ = std::size_t(medium_.lattice.find_node(medium_.reference_node) / BrickLattice::kNodes);
};

TEST_F(PartedSmoke, IsWholeBehindAWallBesideIt) {
    const auto box = with_wall(0, 1.5f);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->low, ivec3(2, 0, 0));
    EXPECT_EQ(box->high, ivec3(7));
}

TEST_F(PartedSmoke, LosesTheLayerThatReachesBeyondAWall) {
    const auto box = with_wall(1, 6.5f);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->high, ivec3(6));
}

TEST_F(PartedSmoke, IsPartedByAWallWithin) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float at : {3.5f, 4.5f, 5.5f})
            EXPECT_FALSE(with_wall(axis, at)) << axis << " " << at;
}

}  // namespace
}  // namespace brisance
