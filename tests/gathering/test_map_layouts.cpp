// The size of shadow maps that an error asks for.
#include <gtest/gtest.h>

#include "gathering/map_layouts.h"

namespace brisance {
namespace {

LightingSettings asking_for(float error) {
    LightingSettings settings;
    settings.error = error;
    return settings;
}

// Texels grow as error^(-3/4), distances as the square root of that: docs/methods/lighting_grid.md.
TEST(MapLayouts, AHundredthNeedsTwentyTexelsAndTwoHundredthsTwelve) {
    EXPECT_EQ(shadow_resolution(asking_for(0.02f)), 12);
    EXPECT_EQ(shadow_distances(asking_for(0.02f)), 10);
    EXPECT_EQ(shadow_resolution(asking_for(0.01f)), 20);
    EXPECT_EQ(shadow_distances(asking_for(0.01f)), 13);
    EXPECT_EQ(shadow_resolution(asking_for(0.05f)), 6);
}

TEST(MapLayouts, NoErrorMakesThemUselessOrEndless) {
    EXPECT_EQ(shadow_resolution(asking_for(1.0f)), 4);
    EXPECT_EQ(shadow_distances(asking_for(1.0f)), 4);
    EXPECT_EQ(shadow_resolution(asking_for(1e-6f)), shadow_resolution(asking_for(1e-3f)));
}

TEST(MapLayouts, AreAsGivenWhereTheyAreGiven) {
    LightingSettings settings = asking_for(0.05f);
    settings.shadow_resolution = 31;
    settings.shadow_distances = 7;
    EXPECT_EQ(shadow_resolution(settings), 31);
    EXPECT_EQ(shadow_distances(settings), 7);
}

}  // namespace
}  // namespace brisance
