// The lattice of the series follows the error that the picture may have.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures/media.h"
#include "scattering/lattice_level.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kNoLimit = 20;

Medium smoke_of(const NodeBox& box, double spacing, const NodeScalar& density, float extinction = 4.0f) {
    Recipe recipe;
    recipe.box = box;
    recipe.world_from_index = cubic(spacing);
    recipe.density = density;
    recipe.settings.smoke.extinction_per_metre = extinction;
    recipe.settings.smoke.albedo = Rgb(0.8f);
    return make_medium(recipe);
}

double mean_level(const SmokeMet& smoke, float error = 0.02f, const ScatteringSettings& settings = {}) {
    const LatticeChoice choice = lattice_of_series(smoke, settings, error, kNoLimit);
    return choice.level + double(choice.share_of_coarser);
}

SmokeMet in_cube(int nodes, double spacing) {
    return smoke_met(smoke_of(
        cube(0, nodes - 1), spacing, [](const ivec3&) { return 1.0f; }, 8.0f));
}

TEST(LatticeLevel, GivesWayGraduallyAsSmokeGetsThinner) {
    double last = 0.0;
    for (float depth = 8.0f; depth > 0.05f; depth *= 0.99f) {
        const double level = mean_level({depth, 0.8f, 0.0f, 100.0f});
        EXPECT_GE(level, last) << depth;
        EXPECT_LT(level - last, 0.15) << depth;
        last = level;
    }
    EXPECT_EQ(mean_level({8.0f, 0.8f, 0.0f, 100.0f}), 0.0);
    EXPECT_EQ(last, 2.0);
}

// A small cloud that grows, however thin and dark. No lattice of an extinction pyramid is as coarse.
TEST(LatticeLevel, SmallSmokeKeepsVoxelsOfAnEighthOfItsRadius) {
    for (const float albedo : {0.4f, 0.8f, 1.0f}) {
        double last = 0.0;
        for (float radius = 1.0f; radius < 40.0f; radius += 0.1f) {
            const double level = mean_level({1e-3f, albedo, 0.0f, radius});
            EXPECT_LE(std::exp2(level), std::max(1.0f, 0.1251f * radius)) << radius;
            EXPECT_GE(level, last) << radius;
            EXPECT_LT(level - last, 0.1) << radius;
            last = level;
        }
        EXPECT_EQ(last, 2.0);
    }
}

TEST(LatticeLevel, HasTheSameSpacingForFinerVoxels) {
    EXPECT_NEAR(mean_level(in_cube(48, 0.05)), mean_level(in_cube(24, 0.1)) + 1.0, 1e-3);
}

TEST(LatticeLevel, DoesNotKnowHowMuchSmokeThereIs) {
    EXPECT_NEAR(mean_level(in_cube(60, 0.1)), mean_level(in_cube(24, 0.1)), 1e-3);
}

// Smoke where no light is does not count, however dense; nor does smoke that nobody can see.
TEST(LatticeLevel, FollowsTheSmokeThatScattersLight) {
    const auto density = [](float around) {
        return [around](const ivec3& n) { return std::max(around, ball(n, dvec3(0.0), 12)); };
    };
    const Medium alone = smoke_of(cube(-14, 14), 0.1, density(0.0f)),
                 thin = smoke_of(cube(-30, 30), 0.1, density(1e-7f));
    EXPECT_NEAR(smoke_met(thin).depth, smoke_met(alone).depth, 1e-4f);
    const Medium beside = smoke_of(cube(-30, 30), 0.1, [](const ivec3& n) {
        return std::max(ball(n, dvec3(0.0), 12), 20.0f * ball(n, dvec3(22.0, 0.0, 0.0), 6));
    });
    std::vector<Rgb> light(beside.extinction.size());
    for (std::size_t i = 0; i < light.size(); ++i)
        light[i] = Rgb(beside.lattice.node(i).x < 14 ? beside.extinction[i] : 0.0f);
    EXPECT_NEAR(smoke_met(beside, light).depth, smoke_met(alone).depth, 1e-4f);
    EXPECT_GT(smoke_met(beside).depth, 2.0f * smoke_met(alone).depth);
}

TEST(LatticeLevel, FollowsWhatTheShotStates) {
    const SmokeMet smoke{0.5f, 0.8f, 0.0f, 100.0f};
    double last = 100.0;
    for (const float error : {0.05f, 0.02f, 0.0175f, 0.015f, 0.0125f, 0.01f, 0.005f, 0.001f}) {
        EXPECT_LE(mean_level(smoke, error), last) << error;
        last = mean_level(smoke, error);
    }
    EXPECT_EQ(last, 0.0);
    EXPECT_EQ(mean_level(smoke, 0.0f), 0.0);
    ScatteringSettings settings;
    settings.fine_bounces = 0;
    EXPECT_LT(mean_level(smoke, 0.02f, settings), mean_level(smoke, 0.02f)) << "nothing corrects it";
    settings.lattice_level = 5;
    EXPECT_EQ(mean_level(smoke, 0.02f, settings), 5.0);
}

TEST(LatticeLevel, FineBouncesReplaceWhatIsSolvedOnCoarserLattices) {
    ScatteringSettings settings;
    EXPECT_EQ(share_of_fine_bounces({2, 0.0f}, settings, 0.02f), 1.0f);
    EXPECT_EQ(share_of_fine_bounces({0, 0.25f}, settings, 0.02f), 0.25f);
    EXPECT_EQ(share_of_fine_bounces({0, 0.0f}, settings, 0.02f), 0.0f);
    EXPECT_NEAR(share_of_fine_bounces({2, 0.0f}, settings, 0.015f), 0.5f, 1e-5f);
    EXPECT_EQ(share_of_fine_bounces({2, 0.0f}, settings, 0.01f), 0.0f);
    settings.fine_bounces = 1;
    EXPECT_EQ(share_of_fine_bounces({2, 0.0f}, settings, 0.001f), 1.0f) << "it is stated";
    settings.fine_bounces = 0;
    EXPECT_EQ(share_of_fine_bounces({2, 0.0f}, settings, 0.02f), 0.0f);
}

}  // namespace
}  // namespace brisance
