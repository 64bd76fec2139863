// The size of shadow maps that an error asks for.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace brisance
