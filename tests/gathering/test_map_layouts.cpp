// The size of shadow maps that an error asks for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures/media.h"
#include "gathering/map_layouts.h"

namespace brisance {
namespace {

LightingSettings with_error(float error) {
    LightingSettings settings;
    settings.error = error;
    return settings;
}

// Texels grow as error^(-3/4), distances as the square root of that: docs/methods/lighting_grid.md.
TEST(MapLayouts, AHundredthNeedsTwentyTexelsAndTwoHundredthsTwelve) {
    EXPECT_EQ(shadow_resolution(with_error(0.02f)), 12);
    EXPECT_EQ(shadow_distances(with_error(0.02f)), 10);
    EXPECT_EQ(shadow_resolution(with_error(0.01f)), 20);
    EXPECT_EQ(shadow_distances(with_error(0.01f)), 13);
    EXPECT_EQ(shadow_resolution(with_error(0.05f)), 6);
}

TEST(MapLayouts, NoErrorMakesThemUselessOrEndless) {
    EXPECT_EQ(shadow_resolution(with_error(1.0f)), 4);
    EXPECT_EQ(shadow_distances(with_error(1.0f)), 4);
    EXPECT_EQ(shadow_resolution(with_error(1e-6f)), shadow_resolution(with_error(1e-3f)));
}

TEST(MapLayouts, AreAsGivenWhereTheyAreGiven) {
    LightingSettings settings = with_error(0.05f);
    settings.shadow_resolution = 31;
    settings.shadow_distances = 7;
    EXPECT_EQ(shadow_resolution(settings), 31);
    EXPECT_EQ(shadow_distances(settings), 7);
}

// The relative error of a sum over n maps of r^2 texels goes as r^(-4/3) / sqrt(n).
TEST(MapLayouts, FewLightsHaveFinerMaps) {
    const Medium medium = testing::make_medium(testing::glowing_ball(8, 1.0f));
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    LightField field{};
    field.pyramid = &pyramid;
    field.alpha = 2.0f;
    const auto resolution = [&](std::size_t lights) {
        GridLevel level;
        level.level = 1;
        level.spacing = 2.0f * medium.spacing;
        level.position.resize(lights, vec3(0.0f));
        return double(map_layout(field, level, false).resolution);
    };
    const auto error = [&](std::size_t lights) {
        return std::pow(resolution(lights), -4.0 / 3.0) / std::sqrt(double(lights));
    };
    EXPECT_EQ(resolution(4096), 12.0);
    EXPECT_EQ(resolution(100000), 12.0);
    for (const std::size_t lights : {20, 100, 1000}) {
        EXPECT_NEAR(error(lights) / error(4096), 1.0, 0.1) << lights;
        EXPECT_LT(double(lights) * std::pow(resolution(lights), 2.0), 4096.0 * 12.0 * 12.0) << lights;
    }
}

// A row of lights with intensities 1, 2, 4, ... among receivers that are seen from `seen` on.
struct WeightedLights {
    GridLevel level;
    ReceiverImportance importance;
    ShadowMapLayout layout;

    explicit WeightedLights(int seen = 32, float unit = 1.0f) {
        level.level = 1;
        for (int i = 0; i < 64; ++i) {
            level.vertex.push_back({i, 0, 0});
            level.intensity.emplace_back(unit * std::exp2(float(i % 8)));
        }
        std::vector<ivec3> bricks;
        for (int b = -2; b < 18; ++b)
            bricks.push_back({b, 0, 0});
        importance.lattice = BrickLattice(std::move(bricks));
        for (std::size_t i = 0; i < importance.lattice.node_count(); ++i)
            importance.value.push_back(importance.lattice.node(i).x < seen ? 0.0f : 0.3f);
        layout.resolution = 12;
    }
    std::vector<std::uint8_t> resolutions() const { return map_resolutions(level, layout, &importance); }
};

TEST(MapResolutions, AreAllAlikeWhereNothingIsKnownOfTheReceivers) {
    const WeightedLights lights;
    EXPECT_EQ(map_resolutions(lights.level, lights.layout, nullptr), std::vector<std::uint8_t>(64, 12));
}

TEST(MapResolutions, AreAllAlikeWhereNothingIsSeen) {
    WeightedLights lights;
    std::ranges::fill(lights.importance.value, 0.0f);
    EXPECT_EQ(lights.resolutions(), std::vector<std::uint8_t>(64, 12));
}

TEST(MapResolutions, AreLeastForLightsThatNoSeenReceiverIsNearTo) {
    const std::vector<std::uint8_t> resolutions = WeightedLights().resolutions();
    for (int i = 0; i < 16; ++i)
        EXPECT_EQ(resolutions[i], kLeastResolution) << i;
    for (int i = 60; i < 64; ++i)  // the brighter ones
        EXPECT_GT(resolutions[i], kLeastResolution) << i;
}

TEST(MapResolutions, FollowTheLightsAndNotTheirUnit) {
    const std::vector<std::uint8_t> resolutions = WeightedLights().resolutions();
    EXPECT_EQ(resolutions, WeightedLights(32, 1e6f).resolutions());
    for (int i = 57; i < 64; ++i)
        EXPECT_GE(resolutions[i], resolutions[i - 1]) << i;
    EXPECT_GT(resolutions[63], resolutions[56]);
}

// Errors of maps as the power -4/3 of their resolution, rounded to even numbers.
TEST(MapResolutions, KeepTheSumOfErrorsForFewerTexels) {
    const WeightedLights lights(-1000);
    const std::vector<std::uint8_t> resolutions = lights.resolutions();
    const auto error = [](double texels) { return std::pow(texels, -4.0 / 3.0); };
    double sum = 0.0, alike = 0.0, texels = 0.0;
    for (int i = 0; i < 64; ++i) {
        sum += lights.level.intensity[i].x * error(resolutions[i]);
        alike += lights.level.intensity[i].x * error(12.0);
    }
    for (const double r : resolutions)
        texels += r * r;
    EXPECT_NEAR(sum / alike, 1.0, 0.1);
    EXPECT_LT(texels, 0.6 * 64.0 * 12.0 * 12.0);
}

}  // namespace
}  // namespace brisance
