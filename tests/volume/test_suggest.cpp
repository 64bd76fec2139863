// The suggested settings must give a visible picture, whatever the units of the file.
#include <gtest/gtest.h>

#include "volume/suggest.h"

namespace brisance {
namespace {

// A cube of `side` voxels of `width` metres with constant value.
MeasuredGrid cube(double value, int side = 50, double width = 0.1) {
    MeasuredGrid grid;
    grid.info.world_from_index = dmat4(dmat3(width));
    grid.info.active_min = ivec3(0);
    grid.info.active_max = ivec3(side - 1);
    grid.census.active_voxels = static_cast<std::uint64_t>(side) * side * side;
    grid.census.minimum = grid.census.maximum = grid.census.mean = value;
    return grid;
}

TEST(Suggestion, AUniformCubeGetsAnOpticalDepthNearTen) {
    for (const double density : {0.01, 1.0, 30.0}) {
        for (const double width : {0.01, 1.0}) {
            const MeasuredGrid grid = cube(density, 50, width);
            const SuggestedLook look = suggest_look(&grid, nullptr, nullptr);
            const double depth = look.extinction_per_metre * density * 50.0 * width;
            EXPECT_GT(depth, 7.0);
            EXPECT_LT(depth, 13.0);
        }
    }
}

TEST(Suggestion, SmallTemperaturesAreNotKelvin) {
    const MeasuredGrid small = cube(2.4), large = cube(50.0), kelvin = cube(1800.0);
    EXPECT_FLOAT_EQ(suggest_look(nullptr, nullptr, &small).temperature_kelvin.y, 2400.0f);
    EXPECT_FLOAT_EQ(suggest_look(nullptr, nullptr, &large).temperature_kelvin.y, 3000.0f);
    const SuggestedLook look = suggest_look(nullptr, nullptr, &kelvin);
    EXPECT_FLOAT_EQ(look.temperature_in.y, 1800.0f);
    EXPECT_FLOAT_EQ(look.temperature_kelvin.y, 1800.0f);
    EXPECT_EQ(look.fire, SuggestedFire::Blackbody);
}

TEST(Suggestion, FireThatReachesBeyondTheSmokeShinesWithoutIt) {
    const MeasuredGrid density = cube(1.0, 50), flame = cube(5.0, 60), inside = cube(5.0, 40);
    EXPECT_FALSE(suggest_look(&density, &flame, nullptr).emission_follows_density);
    EXPECT_TRUE(suggest_look(&density, &inside, nullptr).emission_follows_density);
    EXPECT_EQ(suggest_look(&density, &flame, nullptr).max_flame, 5.0f);
}

TEST(Suggestion, NothingIsDividedByNothing) {
    const MeasuredGrid empty = cube(0.0, 0), negative = cube(-1.0);
    for (const MeasuredGrid* density : {&empty, &negative}) {
        const SuggestedLook look = suggest_look(density, &empty, &empty);
        EXPECT_EQ(look.extinction_per_metre, 1.0f);
        EXPECT_EQ(look.max_density, 0.0f);
        EXPECT_EQ(look.fire, SuggestedFire::None);
    }
}

}  // namespace
}  // namespace brisance
