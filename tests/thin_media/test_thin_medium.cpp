// Thin smoke around a burst that keeps almost all of its light: what it scatters came through the burst's skin.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "fixtures/media.h"
#include "gathering/escape_probability.h"
#include "medium/lattice/extinction_pyramid.h"
#include "render/render_frame.h"
#include "thin_media/thin_medium.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kWidth = 32, kHeight = 24, kRadius = 12;

// A ragged ball that burns inside, in a box of smoke `thin` times as dense.
Recipe burst_in_haze_recipe(float thin, float mean_cosine, float extinction) {
    Recipe recipe;
    recipe.box = cube(-28, 28);
    recipe.world_from_index = cubic(0.05);
    recipe.density = [thin](const ivec3& n) {
        const float lumps = noise(n >> 2, 1) < 0.8f ? 0.4f + noise(n, 2) : 0.0f;
        return std::max(thin, ball(n, dvec3(0.0), kRadius) * lumps);
    };
    recipe.flame = [](const ivec3& n) { return ball(n, dvec3(0.0), kRadius - 3) * noise(n >> 1, 3); };
    recipe.settings = black_smoke();
    recipe.settings.smoke.extinction_per_metre = extinction;
    recipe.settings.smoke.albedo = Rgb(0.8f);
    recipe.settings.smoke.mean_cosine = mean_cosine;
    return recipe;
}

Medium burst_in_haze(float thin, float mean_cosine = 0.0f, float extinction = 30.0f) {
    return make_medium(burst_in_haze_recipe(thin, mean_cosine, extinction));
}

Image picture(const Medium& medium, RenderMethod method) {
    Shot shot;
    shot.method = method;
    shot.medium.smoke.mean_cosine = medium.mean_cosine;
    shot.camera_given = true;
    shot.camera.eye = {0.5, -7.0, 0.3};
    shot.camera.target = {0.0, 0.0, 0.0};
    shot.camera.vertical_fov_degrees = 30.0;
    shot.camera.width = kWidth;
    shot.camera.height = kHeight;
    shot.camera.samples_per_axis = 2;
    shot.tracing.samples = 128;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    Progress silent;
    return render_medium(shot, medium, silent).image;
}

// The layer's mean over pixels that look past the burst at no more than `far` of its radii.
double beside_burst(const Image& image, const char* cell, double far) {
    const Layer& layer = image.layer(cell);
    const std::size_t channels = layer.channels.size();
    const double pixels_per_metre = kHeight / (2.0 * 7.0 * std::tan(15.0 * 3.14159265 / 180.0));
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double r =
                std::hypot(x + 0.5 - kWidth / 2, y + 0.5 - kHeight / 2) / (pixels_per_metre * kRadius * 0.05);
            if (r < 1.15 || r > far)
                continue;
            sum += layer.pixels[(std::size_t(y) * kWidth + x) * channels];
            ++count;
        }
    return sum / count;
}

class BurstInHaze : public ::testing::TestWithParam<float> {};

TEST_P(BurstInHaze, ScattersWhatComesThroughTheSkin) {
    const Medium medium = burst_in_haze(0.002f, GetParam());
    const Image grid = picture(medium, RenderMethod::LightingGrid), paths = picture(medium, RenderMethod::Path);
    for (const char* cell : {"MV", "MM"})
        for (const double far : {1.5, 3.0}) {
            const double ours = beside_burst(grid, cell, far), truth = beside_burst(paths, cell, far);
            std::printf("g %.1f, %s to %.1f radii: %.6f, paths %.6f (%+.1f %%)\n", GetParam(), cell, far, ours, truth,
                        100.0 * (ours / truth - 1.0));
            // Right beside the burst both hierarchies serve, neither at its best.
            EXPECT_NEAR(ours, truth, (far < 2.0 ? 0.15 : 0.08) * truth) << cell;
        }
}

INSTANTIATE_TEST_SUITE_P(Phases, BurstInHaze, ::testing::Values(0.0f, 0.6f));

struct Around {
    explicit Around(const Medium& medium) : pyramid(medium, 4), depths(pyramid, 2) {}
    ThinMedium haze(const Medium& medium, float error = 0.02f, LitBy lit_by = LitBy::Fire) const {
        return {medium,
                depths,
                std::vector<std::uint8_t>(medium.lattice.node_count(), 1),
                {vec3(0.5f, -7.0f, 0.3f)},
                error,
                nullptr,
                lit_by};
    }
    ExtinctionPyramid pyramid;
    PointDepths depths;
};

TEST(ThinMedium, IsNotPaidForWhereThereIsNone) {
    const Medium medium = make_medium(glowing_ball(20, 3.0f));
    EXPECT_TRUE(Around(medium).haze(medium).empty());
}

// Smoke of albedo 0.8 sends back R = 0.34 of diffuse light, to half of the directions from which light reaches haze.
TEST(ThinMedium, CountsLessUnderASkyByWhatSmokeSendsBack) {
    const Medium medium = burst_in_haze(0.002f);
    const Around around(medium);
    const auto largest_error = [&](LitBy lit_by) {
        double none = 4.0, some = 1e-4;
        while (none / some > 1.04) {
            const double error = std::sqrt(none * some);
            (around.haze(medium, float(error), lit_by).empty() ? none : some) = error;
        }
        return some;
    };
    const double by_fire = largest_error(LitBy::Fire), under_sky = largest_error(LitBy::Skies);
    ASSERT_LT(by_fire, 3.8);
    EXPECT_NEAR(under_sky / by_fire, 0.5 * 0.34 / (1.0 + 0.5 * 0.34), 0.01);
}

TEST(ThinMedium, HollowsInTheSmokeAreNone) {
    Recipe recipe;
    recipe.box = cube(-40, 40);
    recipe.world_from_index = cubic(0.05);
    // Two thirds of the ball are hollow, and nothing sees into it. There is haze in it and around it.
    recipe.density = [](const ivec3& n) {
        return std::max(0.001f, ball(n, dvec3(0.0), 38) * (1.0f - ball(n, dvec3(0.0), 33)));
    };
    recipe.flame = [](const ivec3& n) { return ball(n, dvec3(0.0), 5); };
    recipe.settings = black_smoke();
    recipe.settings.smoke.albedo = Rgb(0.5f);
    recipe.settings.smoke.extinction_per_metre = 60.0f;
    const Medium medium = make_medium(recipe);
    const ThinMedium haze = Around(medium).haze(medium);
    ASSERT_FALSE(haze.empty());
    const std::int64_t middle = medium.lattice.find_node(medium.reference_node);
    const std::int64_t outside = medium.lattice.find_node(medium.reference_node + ivec3(39, 39, 0));
    ASSERT_GE(middle, 0);
    ASSERT_GE(outside, 0);
    EXPECT_EQ(haze.nodes()[std::size_t(middle)], 0);
    EXPECT_EQ(haze.nodes()[std::size_t(outside)], 1);
}

TEST(ThinMedium, AsksAtFewerPointsThanItHasNodes) {
    const Medium medium = burst_in_haze(0.002f);
    const ThinMedium haze = Around(medium).haze(medium);
    EXPECT_GT(haze.node_count(), std::size_t{100000});
    EXPECT_LT(haze.point_count(), haze.node_count() / 2);
}

// Haze counts as such more or less, by how opaque the burst is that it sees. Its light changes slowly all the same.
TEST(ThinMedium, AsksAtFewPointsWhereItsTreatmentFades) {
    const Medium medium = burst_in_haze(0.002f, 0.0f, 3.5f);
    const ThinMedium haze = Around(medium).haze(medium);
    ASSERT_FALSE(haze.empty());
    std::size_t fading = 0;
    for (const float rest : haze.rest())
        fading += rest > 0.02f && rest < 0.98f;
    EXPECT_GT(fading, haze.node_count() / 2);
    EXPECT_LT(haze.point_count(), haze.node_count() / 2);
}

// Light close to a flame is not interpolated over half a brick, however thin the smoke is.
TEST(ThinMedium, AsksEachNodeAroundAFlame) {
    Recipe recipe = burst_in_haze_recipe(0.002f, 0.0f, 30.0f);
    const NodeScalar inside = recipe.flame;
    const ivec3 spark(-20, 20, 20);
    recipe.flame = [=](const ivec3& n) { return std::max(inside(n), ball(n - spark, dvec3(0.0), 2)); };
    const Medium medium = make_medium(recipe);
    const ThinMedium haze = Around(medium).haze(medium);
    ASSERT_FALSE(haze.even_bricks().empty());
    const ivec3 brick = (medium.reference_node + spark) >> 3;
    for (const std::uint32_t b : haze.even_bricks()) {
        const ivec3 apart = glm::abs(medium.lattice.brick(b) - brick);
        EXPECT_GT(std::max({apart.x, apart.y, apart.z}), 1);
    }
}

// What mix() replaces and what it leaves are one.
TEST(ThinMedium, LeavesTheRest) {
    const Medium medium = burst_in_haze(0.002f);
    const ThinMedium haze = Around(medium).haze(medium);
    const std::size_t n = medium.lattice.node_count();
    Gathered dark, light;
    dark.resize(n, false, false);
    light.resize(n, false, false);
    std::fill(light.fluence.begin(), light.fluence.end(), 1.0f);
    haze.mix(dark, light);
    const std::vector<float> rest = haze.rest();
    ASSERT_EQ(rest.size(), n);
    for (std::size_t i = 0; i < n; ++i)
        ASSERT_FLOAT_EQ(light.fluence[i], rest[i]) << i;
}

}  // namespace
}  // namespace brisance
