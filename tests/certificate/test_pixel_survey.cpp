// Surveys of few pixels: sums of any quantity over all of them, and how well they are known.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "certificate/pixel_survey.h"
#include "fixtures/media.h"

namespace brisance {
namespace {

TEST(PixelSurvey, SumsAndTheirVariancesHaveNoBias) {
    constexpr int width = 40, height = 25, repeats = 2000;
    std::vector<double> size(width * height), value(size);
    double total = 0.0;
    for (std::size_t p = 0; p < size.size(); ++p) {
        size[p] = p % 7 == 0 ? 0.0 : 0.1 + testing::noise(ivec3(int(p), 0, 0), 1);
        value[p] = p % 7 == 0 ? 0.0 : double(testing::noise(ivec3(int(p), 0, 0), 2)) + 0.001 * double(p);
        total += value[p];
    }
    double mean = 0.0, square = 0.0, variance = 0.0;
    for (int k = 0; k < repeats; ++k) {
        const PixelSurvey survey(size, width, 60, k);
        ASSERT_EQ(survey.draws().size(), 60u);
        std::vector<double> a;
        for (const PixelSurvey::Draw& d : survey.draws()) {
            ASSERT_GT(size[d.pixel], 0.0);
            a.push_back(d.weight * value[d.pixel]);
        }
        const SurveyedSums s = surveyed_sums(a, a);
        mean += s.a / repeats;
        square += s.a * s.a / repeats;
        variance += s.aa / repeats;
        EXPECT_EQ(s.aa, s.bb);
    }
    const double spread = square - mean * mean;
    EXPECT_NEAR(mean, total, 4.0 * std::sqrt(spread / repeats));
    EXPECT_NEAR(variance / spread, 1.0, 4.0 * std::sqrt(2.0 / repeats));
}

// Strata whose pairs differ by as much count as so many; where one of them makes all of the variance it is known from
// one difference. Of normally distributed ones the mean over 400 surveys has a standard error below 1.
TEST(PixelSurvey, DegreesOfFreedomCountTheStrataThatMakeTheVariance) {
    constexpr std::size_t kStrata = 100;
    const auto degrees = [](const std::function<double(std::size_t)>& half) {
        std::vector<double> a;
        for (std::size_t k = 0; k < kStrata; ++k) {
            a.push_back(half(k));
            a.push_back(-half(k));
        }
        return surveyed_sums(a, a).degrees_of_freedom;
    };
    EXPECT_EQ(degrees([](std::size_t) { return 0.0; }), double(kStrata));
    EXPECT_EQ(degrees([](std::size_t) { return 3.0; }), double(kStrata));
    EXPECT_NEAR(degrees([](std::size_t k) { return k == 7 ? 1e6 : 1.0; }), 1.0, 1e-6);
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    double mean = 0.0;
    for (int k = 0; k < 400; ++k)
        mean += degrees([&](std::size_t) { return normal(random); }) / 400.0;
    EXPECT_GT(mean, 0.8 * double(kStrata));
}

TEST(PixelSurvey, OfNothingDrawsNothing) {
    EXPECT_TRUE(PixelSurvey(std::vector<double>(12, 0.0), 4, 10, 1).draws().empty());
}

TEST(PixelSurvey, WidthsAreStudents) {
    EXPECT_NEAR(half_width(10), 2.2281, 0.003);
    EXPECT_NEAR(half_width(30), 2.0423, 0.0005);
    EXPECT_NEAR(half_width(1000000), 1.959966, 1e-5);
}

}  // namespace
}  // namespace brisance
