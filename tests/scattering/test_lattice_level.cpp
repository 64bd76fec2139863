// The lattice of the series follows the volume that the smoke fills.
#include <gtest/gtest.h>

#include <algorithm>

#include "fixtures/media.h"
#include "scattering/lattice_level.h"

namespace brisance {
namespace {

using namespace testing;

LatticeChoice choice(const NodeBox& box, const NodeScalar& density) {
    Recipe recipe;
    recipe.box = box;
    recipe.world_from_index = cubic(0.05);
    recipe.density = density;
    recipe.settings = black_smoke();
    const Medium medium = make_medium(recipe);
    return automatic_lattice(ExtinctionPyramid(medium, ExtinctionPyramid::kMaxLevels), 1.0);
}

double mean_level(const LatticeChoice& c) {
    return c.level + double(c.share_of_coarser);
}

TEST(LatticeLevel, GivesWayGraduallyToTheNext) {
    double last = 0.0;
    for (int nodes = 40; nodes <= 46; ++nodes) {
        const double level = mean_level(choice({ivec3(0), ivec3(nodes - 1)}, [](const ivec3&) { return 1.0f; }));
        EXPECT_GE(level, last) << nodes;
        EXPECT_LT(level - last, 0.5) << nodes;
        last = level;
    }
    EXPECT_EQ(last, 1.0);
}

TEST(LatticeLevel, HasTheSameSpacingForFinerVoxels) {
    const auto of_ball = [](int radius) {
        return choice(cube(-radius, radius), [radius](const ivec3& n) { return ball(n, dvec3(0.0), radius); });
    };
    const LatticeChoice coarse = of_ball(22), fine = of_ball(44);
    EXPECT_EQ(coarse.level + 1, fine.level);
    EXPECT_NEAR(coarse.share_of_coarser, fine.share_of_coarser, 0.02);
}

TEST(LatticeLevel, IsTheSameAmongSmokeTooThinToBeSeen) {
    const auto among = [](float thin) {
        return choice(cube(-40, 40), [thin](const ivec3& n) { return std::max(thin, ball(n, dvec3(0.0), 20)); });
    };
    EXPECT_EQ(among(0.0f).level, 0);
    EXPECT_NEAR(mean_level(among(1e-7f)), mean_level(among(0.0f)), 1e-3);
}

// More error, coarser lattices, and as much more of a bounce that corrects them.
TEST(LatticeLevel, FineBouncesFadeInWithTheError) {
    const ScatteringSettings automatic;
    double room = 0.0, share = -1.0;
    for (const float error : {0.005f, 0.01f, 0.0125f, 0.015f, 0.0175f, 0.02f, 0.05f}) {
        const double now = crowding(automatic, error), part = share_of_fine_bounces({2, 0.0f}, automatic, error);
        EXPECT_GE(now, room) << error;
        EXPECT_GE(part, share) << error;
        if (share >= 0.0 && error <= 0.02f) {
            EXPECT_LT(part - share, 0.3) << error;
        }
        room = now;
        share = part;
    }
    EXPECT_EQ(crowding(automatic, 0.01f), 1.0);
    EXPECT_EQ(share_of_fine_bounces({2, 0.0f}, automatic, 0.01f), 0.0f);
    EXPECT_EQ(share, 1.0);
    EXPECT_EQ(share_of_fine_bounces({0, 0.25f}, automatic, 0.02f), 0.25f)
        << "as much as is solved on a coarser lattice";
    ScatteringSettings none;
    none.fine_bounces = 0;
    EXPECT_EQ(crowding(none, 0.05f), 1.0);
    EXPECT_EQ(share_of_fine_bounces({2, 0.0f}, none, 0.05f), 0.0f);
}

}  // namespace
}  // namespace brisance
