#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "error_curve.h"

namespace brisance {
namespace {

const std::vector<double> kTimes = {1.0, 3.0, 10.0, 30.0};

// error(t) at kTimes.
ErrorCurve curve(const std::function<double(double)>& error, Tail tail) {
    std::vector<CurvePoint> points;
    points.reserve(kTimes.size());
    for (const double t : kTimes)
        points.push_back({t, error(t), 0.0});
    return {points, tail};
}

double averaged(double seconds) {
    return 0.5 / std::sqrt(seconds);
}

TEST(ErrorCurve, OfAnAverageHasSlopeOneHalf) {
    const std::optional<PowerLaw> law = curve(averaged, Tail::Average).law();
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->exponent, -0.5, 1e-12);
    EXPECT_NEAR(law->constant, 0.5, 1e-12);
}

TEST(ErrorCurve, ReadsTimesOfAPowerLawExactlyBetweenRunsAndBeyondThem) {
    const ErrorCurve c = curve(averaged, Tail::Average);
    for (const double seconds : {1.7, 9.0, 29.0}) {
        const Reading reading = c.time_to(averaged(seconds));
        EXPECT_EQ(reading.kind, ReadingKind::Interpolated);
        EXPECT_NEAR(reading.value, seconds, 1e-9 * seconds);
    }
    const Reading later = c.time_to(averaged(4000.0));
    EXPECT_EQ(later.kind, ReadingKind::Extrapolated);
    EXPECT_NEAR(later.value, 4000.0, 1e-6);
}

TEST(ErrorCurve, ReadsErrorsOfAPowerLawExactlyBetweenRunsAndBeyondThem) {
    const ErrorCurve c = curve(averaged, Tail::Average);
    EXPECT_EQ(c.error_after(0.9).kind, ReadingKind::NotReached);
    EXPECT_EQ(c.error_after(10.0).kind, ReadingKind::Interpolated);
    EXPECT_NEAR(c.error_after(10.0).value, averaged(10.0), 1e-15);
    EXPECT_NEAR(c.error_after(20.0).value, averaged(20.0), 1e-12);
    EXPECT_EQ(c.error_after(100.0).kind, ReadingKind::Extrapolated);
    EXPECT_NEAR(c.error_after(100.0).value, averaged(100.0), 1e-12);
}

TEST(ErrorCurve, OfABiasedMethodStaysAtItsFloor) {
    const double bias = 0.03;
    const ErrorCurve c = curve([&](double t) { return bias + averaged(t); }, Tail::Floor);
    const double least = bias + averaged(30.0);
    EXPECT_DOUBLE_EQ(c.floor(), least);
    EXPECT_EQ(c.time_to(0.02).kind, ReadingKind::NotReached);
    EXPECT_EQ(c.time_to(0.99 * least).kind, ReadingKind::NotReached);
    EXPECT_EQ(c.time_to(0.2).kind, ReadingKind::Interpolated);
    // Straight lines in the logarithms are near the curve between its points.
    EXPECT_NEAR(bias + averaged(c.time_to(0.2).value), 0.2, 0.005);
    EXPECT_EQ(c.error_after(1000.0).kind, ReadingKind::AtMost);
    EXPECT_DOUBLE_EQ(c.error_after(1000.0).value, least);
}

TEST(ErrorCurve, OfAnAverageWithAFloorIsFlatterThanOneHalf) {
    const std::optional<PowerLaw> law = curve([](double t) { return 0.1 + averaged(t); }, Tail::Average).law();
    ASSERT_TRUE(law);
    EXPECT_GT(law->exponent, -0.5);
    EXPECT_LT(law->exponent, -0.1);
}

TEST(ErrorCurve, CountsTheStartUpOnce) {
    // 4 s of preparation, then 0.25 s for each path; the error is that of the paths.
    std::vector<CurvePoint> points;
    for (const double paths : {4.0, 16.0, 64.0})
        points.push_back({4.0 + 0.25 * paths, 0.8 / std::sqrt(paths), paths});
    const ErrorCurve c(points, Tail::Average);
    EXPECT_NEAR(c.startup(), 4.0, 1e-12);
    EXPECT_NEAR(c.law_of_work()->exponent, -0.5, 1e-12);
    EXPECT_LT(c.law()->exponent, -0.5) << "the start-up is spread over more and more paths";
    EXPECT_NEAR(c.time_to(0.8 / std::sqrt(1000.0)).value, 254.0, 1e-9);
    EXPECT_NEAR(c.error_after(254.0).value, 0.8 / std::sqrt(1000.0), 1e-12);
    EXPECT_EQ(ErrorCurve(points, Tail::Floor).startup(), 0.0);
}

TEST(ErrorCurve, HasNoStartUpLongerThanItsFirstRunOrShorterThanNone) {
    EXPECT_EQ(ErrorCurve({{5.0, 0.2, 4.0}, {5.0, 0.1, 16.0}}, Tail::Average).startup(), 5.0);
    EXPECT_EQ(ErrorCurve({{1.0, 0.2, 4.0}, {50.0, 0.1, 16.0}}, Tail::Average).startup(), 0.0);
}

TEST(ErrorCurve, SaysOrLessWhereTheFirstRunIsGoodEnough) {
    const Reading reading = curve(averaged, Tail::Floor).time_to(0.9);
    EXPECT_EQ(reading.kind, ReadingKind::AtMost);
    EXPECT_DOUBLE_EQ(reading.value, 1.0);
    EXPECT_EQ(curve(averaged, Tail::Floor).time_to(0.5).kind, ReadingKind::Interpolated);
}

TEST(ErrorCurve, TakesAnErrorOfZeroForOneTooSmallToMeasure) {
    const ErrorCurve c({{1.0, 0.1, 0.0}, {4.0, 0.0, 0.0}}, Tail::Average);
    EXPECT_EQ(c.time_to(0.02).kind, ReadingKind::AtMost);
    EXPECT_DOUBLE_EQ(c.time_to(0.02).value, 4.0);
    EXPECT_EQ(c.error_after(2.0).kind, ReadingKind::AtMost);
    EXPECT_FALSE(c.law());
}

TEST(ErrorCurve, FindsTheFirstTimeOfAnErrorThatComesAndGoes) {
    const ErrorCurve c({{1.0, 0.4, 0.0}, {2.0, 0.1, 0.0}, {4.0, 0.3, 0.0}, {8.0, 0.05, 0.0}}, Tail::Floor);
    const Reading reading = c.time_to(0.2);
    EXPECT_GT(reading.value, 1.0);
    EXPECT_LT(reading.value, 2.0);
    EXPECT_DOUBLE_EQ(c.floor(), 0.05);
}

TEST(ErrorCurve, SortsItsRunsAndLeavesOutWhatIsNoNumber) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    const ErrorCurve c({{4.0, 0.25, 0.0}, {2.0, nan, 0.0}, {1.0, 0.5, 0.0}, {3.0, infinite, 0.0}, {0.0, 0.1, 0.0}},
                       Tail::Average);
    ASSERT_EQ(c.points().size(), 2u);
    EXPECT_NEAR(c.law()->exponent, -0.5, 1e-12);
}

TEST(ErrorCurve, WithoutRunsReachesNothing) {
    const ErrorCurve none({}, Tail::Average);
    EXPECT_EQ(none.time_to(0.1).kind, ReadingKind::NotReached);
    EXPECT_EQ(none.error_after(1.0).kind, ReadingKind::NotReached);
    EXPECT_FALSE(none.law());
    EXPECT_FALSE(curve(averaged, Tail::Average).law_of_work());
    EXPECT_FALSE(ErrorCurve({{1.0, 0.1, 0.0}}, Tail::Average).law());
    EXPECT_FALSE(ErrorCurve({{1.0, 0.1, 0.0}, {1.0, 0.2, 0.0}}, Tail::Average).law());
}

}  // namespace
}  // namespace brisance
