// What is known of a frame once it has been solved.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fixtures/media.h"
#include "forecast/expected_errors.h"

namespace brisance {
namespace {

// A picture of even cells.
Image picture_of(const std::vector<std::pair<std::string, float>>& cells) {
    Image image{2, 1, {{"", {"R", "G", "B"}, false, std::vector<float>(6, 0.0f)}}};
    for (const auto& [name, radiance] : cells) {
        image.layers.push_back({name, {"R", "G", "B"}, false, std::vector<float>(6, radiance)});
        for (float& v : image.layers[0].pixels)
            v += radiance;
    }
    return image;
}

class ExpectedErrors : public ::testing::Test {
protected:
    ExpectedErrors() {
        testing::Recipe r = testing::glowing_ball(8, 1.0f);
        r.settings.smoke.albedo = Rgb(0.8f);
        medium = testing::make_medium(r);
    }
    std::vector<ExpectedError> of(const Image& image, const std::function<void(ExpectedError&)>& change = {}) const {
        const Plan plan = plan_cells(shot, medium);
        return expected_errors(image, {shot, medium, plan}, statistics, change);
    }

    Shot shot;
    Medium medium;
    Statistics statistics;
};

// Errors of cells are independent. How far the picture's is in doubt is decided by the cells that make its error, not
// by those that make its light: here by MM, beside fire that is brighter and better known.
TEST_F(ExpectedErrors, OfThePictureAreInDoubtAsTheCellsThatMakeThem) {
    const std::vector<ExpectedError> errors = of(picture_of({{"V", 1.0f}, {"MM", 0.8f}}));
    ASSERT_EQ(errors.size(), 3u);
    const ExpectedError &picture = errors[0], &fire = errors[1], &smoke = errors[2];
    EXPECT_NEAR(picture.error, std::hypot(fire.error, 0.8 * smoke.error) / 1.8, 1e-6);
    EXPECT_GT(fire.spread, smoke.spread);
    EXPECT_GT(0.8 * smoke.error, 2.0 * fire.error);
    EXPECT_LT(picture.spread, 1.05 * smoke.spread);
    const std::vector<ExpectedError> alone = of(picture_of({{"MM", 0.8f}}));
    EXPECT_NEAR(alone[0].error, smoke.error, 1e-9);
    EXPECT_NEAR(alone[0].spread, smoke.spread, 1e-9);
}

// The camera knows what noise its samples leave on surfaces: as the root of a sum of squares over all channels.
TEST_F(ExpectedErrors, OfThePictureHoldTheNoiseOfShading) {
    const Image image = picture_of({{"V", 1.0f}});
    const double without = of(image)[0].error;
    statistics.stages.push_back({"camera", 1.0, 0, {{"error_of_shading", std::sqrt(6.0) * 0.03}}});
    EXPECT_NEAR(of(image)[0].error, std::hypot(without, 0.03), 1e-6);
}

// Corrections ask for the part of each cell by itself: it holds no noise of shading, and a black cell has none.
TEST_F(ExpectedErrors, OfOneCellAloneHoldNothingElse) {
    const Image image = picture_of({{"V", 1.0f}, {"MM", 0.8f}});
    statistics.stages.push_back({"camera", 1.0, 0, {{"error_of_shading", 0.1}}});
    const auto alone = [&](const std::string& cell) {
        return of(image, [&](ExpectedError& e) { e.error = e.cell == cell ? e.error : 0.0; })[0].error;
    };
    const std::vector<ExpectedError> errors = of(image);
    EXPECT_NEAR(alone("V"), errors[1].error / 1.8, 1e-6);
    EXPECT_NEAR(alone("MM"), 0.8 * errors[2].error / 1.8, 1e-6);
    EXPECT_EQ(alone("MV"), 0.0);
}

TEST(AsSolved, IsTheLatticeThatTheFrameTook) {
    Shot shot;
    ASSERT_LT(shot.scattering.lattice_level, 0);
    Statistics statistics;
    EXPECT_EQ(as_solved(shot, statistics).scattering.lattice_level, shot.scattering.lattice_level);
    statistics.stages.push_back(
        {"orders of scattering on the coarse lattice", 1.0, 0, {{"nodes", 100}, {"lattice_level", 2}}});
    EXPECT_EQ(as_solved(shot, statistics).scattering.lattice_level, 2);
}

}  // namespace
}  // namespace brisance
