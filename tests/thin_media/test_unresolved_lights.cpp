// Which nodes need lights for receivers outside depends on the smoke at points of space, not on the voxels that hold
// it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures/media.h"
#include "thin_media/seen_share.h"
#include "thin_media/unresolved_lights.h"

namespace brisance {
namespace {

using namespace testing;

constexpr float kHaze = 0.002f;  // relative to the burst

Recipe recipe_of(const NodeBox& box, double voxel, const NodeScalar& density, float extinction) {
    Recipe recipe;
    recipe.box = box;
    recipe.world_from_index = cubic(voxel);
    recipe.density = density;
    recipe.settings = black_smoke();
    recipe.settings.smoke.extinction_per_metre = extinction;
    recipe.settings.smoke.albedo = Rgb(0.8f);
    return recipe;
}

// A ball of 0.6 m in a ball of haze of `haze` m, in a box 2.8 m wide that is empty elsewhere or holds `around`.
Medium burst(double voxel, double haze, float around, float extinction = 30.0f) {
    const int half = int(std::lround(1.4 / voxel));
    return make_medium(recipe_of(
        cube(-half, half), voxel,
        [=](const ivec3& n) {
            const float rest = std::max(around, kHaze * ball(n, dvec3(0.0), haze / voxel));
            return std::max(rest, ball(n, dvec3(0.0), 0.6 / voxel));
        },
        extinction));
}

float at(const Medium& medium, const std::vector<float>& field, const dvec3& metres) {
    const dvec3 node = metres / double(medium.spacing);
    return field[std::size_t(medium.lattice.find_node(ivec3(glm::round(node))))];
}

TEST(UnresolvedLights, AreNoneInHomogeneousSmokeHoweverDense) {
    for (const float extinction : {1e-3f, 1.0f, 30.0f, 1e6f}) {
        const Medium medium = make_medium(recipe_of(
            cube(-20, 20), 0.05, [](const ivec3&) { return 1.0f; }, extinction));
        const std::vector<float> depth = depth_of_seen_lights(medium);
        for (std::size_t i = 0; i < depth.size(); ++i)
            if (medium.extinction[i] == extinction) {
                ASSERT_LE(depth[i], std::exp(-1.0f) * 1.001f) << extinction;
            }
    }
}

TEST(UnresolvedLights, AreWhatHazeSeesOfABurstAndNotWhatTheBurstSees) {
    const Medium medium = burst(0.05, 1.4, 0.0f);
    const std::vector<float> unresolved = unresolved_lights(medium).weight;
    for (const double distance : {0.8, 1.0, 1.3})
        EXPECT_GT(at(medium, unresolved, {0, distance, 0}), 0.99f) << distance;
    for (const double distance : {0.0, 0.3, 0.5})
        EXPECT_LT(at(medium, unresolved, {0, distance, 0}), 0.01f) << distance;
}

// A burst 3.6 to 4.8 mean free paths thick. Beside it the lights of single voxels do; from afar a fifth of its light or
// more is missing.
TEST(UnresolvedLights, AreWhatHazeSeesOfThinBurstsFromAfar) {
    for (const float extinction : {3.0f, 4.0f}) {
        const Medium medium = burst(0.05, 1.4, 0.0f, extinction);
        const UnresolvedLights lights = unresolved_lights(medium);
        EXPECT_GT(at(medium, lights.weight, {0, 1.3, 0}), 0.5f) << extinction;
        EXPECT_GT(at(medium, lights.lost, {0, 1.3, 0}), 0.1f) << extinction;
        EXPECT_LT(at(medium, lights.lost, {0, 1.3, 0}), 0.5f) << extinction;
        for (const double beside : {0.5, 0.6, 0.65})
            EXPECT_LT(at(medium, lights.weight, {0, beside, 0}), 0.2f) << extinction << ", " << beside;
    }
}

// Finer voxels add the shortest distance, which tells beside bursts that are not opaque.
TEST(UnresolvedLights, AreTheSameForFinerVoxels) {
    for (const float extinction : {4.0f, 30.0f}) {
        const Medium coarse = burst(0.1, 1.4, 0.0f, extinction), fine = burst(0.05, 1.4, 0.0f, extinction);
        const UnresolvedLights a = unresolved_lights(coarse), b = unresolved_lights(fine);
        const bool opaque = extinction > 10.0f;
        for (double x = 0.0; x < 1.35; x += 0.1)
            for (double y = 0.0; y < 1.35; y += 0.1) {
                const double r = std::hypot(x, y);
                if (r > 1.3 || std::abs(r - 0.6) < 0.15)
                    continue;
                EXPECT_NEAR(at(coarse, a.lost, {x, y, 0}), at(fine, b.lost, {x, y, 0}), opaque ? 0.1 : 0.15) << r;
                if (opaque || r < 0.6 || r > 1.2) {
                    EXPECT_NEAR(at(coarse, a.weight, {x, y, 0}), at(fine, b.weight, {x, y, 0}), 0.1) << r;
                }
            }
    }
}

// Most of the box holds smoke then, which nobody can see.
TEST(UnresolvedLights, AreTheSameAmongSmokeTooThinToBeSeen) {
    const Medium alone = burst(0.05, 0.9, 0.0f), among = burst(0.05, 0.9, 1e-7f);
    const std::vector<float> a = unresolved_lights(alone).weight, b = unresolved_lights(among).weight;
    for (double x = 0.0; x < 0.85; x += 0.05)
        EXPECT_NEAR(at(alone, a, {x, 0, 0}), at(among, b, {x, 0, 0}), 1e-3) << x;
}

float share_of_haze(const Medium& medium, const vec3& eye) {
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    return seen_share(medium, PointDepths(pyramid, 2), unresolved_lights(medium).lost, eye);
}

TEST(SeenShare, IsTheSameAmongSmokeTooThinToBeSeenAndForFinerVoxels) {
    const vec3 eye(0.5f, -7.0f, 0.3f);
    const float share = share_of_haze(burst(0.05, 0.9, 0.0f), eye);
    EXPECT_GT(share, 0.01f);
    EXPECT_NEAR(share_of_haze(burst(0.05, 0.9, 1e-7f), eye), share, 0.01f * share);
    EXPECT_NEAR(share_of_haze(burst(0.025, 0.9, 0.0f), eye), share, 0.25f * share);
}

// Of two equal slabs behind one another, the second shows the transmittance of the first.
TEST(SeenShare, CountsWhatReachesTheCamera) {
    const Medium medium = make_medium(recipe_of(
        {{-2, -40, -2}, {2, 40, 2}}, 0.05, [](const ivec3&) { return 1.0f; }, 1.0f));
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    std::vector<float> far(medium.lattice.node_count(), 0.0f);
    for (std::size_t i = 0; i < far.size(); ++i)
        far[i] = float(medium.lattice.node(i).y - medium.reference_node.y > 0);
    const float share = seen_share(medium, PointDepths(pyramid, 0), far, {0.0f, -2000.0f, 0.0f});
    EXPECT_NEAR(share, std::exp(-2.0) / (1.0 + std::exp(-2.0)), 0.01);
}

}  // namespace
}  // namespace brisance
