// What is believed of an error: a model's expectation and few samples together.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "certificate/believed_error.h"

namespace brisance {
namespace {

const ExpectedError kModel{"", 0.02, 0.7};

CertifiedError sampled(double error_square, double deviation, double degrees_of_freedom = 100.0) {
    CertifiedError e;
    e.square = error_square;
    e.error = std::sqrt(std::max(0.0, error_square));
    e.square_deviation = deviation;
    e.degrees_of_freedom = degrees_of_freedom;
    return e;
}

TEST(BelievedError, IsTheModelsWithoutSamples) {
    const BelievedError e = believed_error(kModel, nullptr);
    EXPECT_NEAR(e.error, 0.02, 2e-4);
    // Errors beyond a thousand times the expected one are not believed at all.
    EXPECT_NEAR(e.interval.low / (0.02 * std::exp(-kHalfWidthOfModel * 0.7)), 1.0, 0.05);
    EXPECT_NEAR(e.interval.high / (0.02 * std::exp(kHalfWidthOfModel * 0.7)), 1.0, 0.05);
}

TEST(BelievedError, IsTheSamplesWhereThoseAreExact) {
    for (const double truth : {0.004, 0.02, 0.1}) {
        const CertifiedError s = sampled(truth * truth, 0.01 * truth * truth);
        const BelievedError e = believed_error(kModel, &s);
        EXPECT_NEAR(e.error / truth, 1.0, 0.02);
        EXPECT_LT(e.interval.high / e.interval.low, 1.06);
    }
}

// Noise may make the squared error negative: the model keeps the belief above 0.
TEST(BelievedError, StaysBetweenTheModelAndNoisySamples) {
    const CertifiedError below = sampled(-1e-4, 2e-4), above = sampled(16e-4, 6e-4);
    const double low = believed_error(kModel, &below).error, high = believed_error(kModel, &above).error;
    EXPECT_GT(low, 0.002);
    EXPECT_LT(low, 0.02);
    EXPECT_GT(high, 0.02);
    EXPECT_LT(high, 0.04);
}

// A deviation that one or two pixels decide is hardly known itself: such samples move the belief less.
TEST(BelievedError, TrustsFewDegreesOfFreedomLess) {
    const auto believed = [](double degrees_of_freedom) {
        const CertifiedError low = sampled(0.2e-4, 0.4e-4, degrees_of_freedom);
        return believed_error(kModel, &low).error;
    };
    EXPECT_LT(believed(100.0), believed(1.0));
    EXPECT_LT(believed(1.0), kModel.error);
}

TEST(BelievedError, IgnoresSamplesThatSayNothing) {
    const CertifiedError nothing;
    EXPECT_EQ(believed_error(kModel, &nothing).error, believed_error(kModel, nullptr).error);
    EXPECT_EQ(believed_error({"", 0.0, 0.7}, &nothing).error, 0.0);
}

// Where errors are as the model says, 95 % of the intervals hold the truth: 4 standard errors of 2000 trials are 2 %.
TEST(BelievedError, ItsIntervalHoldsTheTruth) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::student_t_distribution<double> student(3.0);
    int held = 0;
    constexpr int trials = 2000;
    for (int k = 0; k < trials; ++k) {
        const double truth = kModel.error * std::exp(kModel.spread * student(random));
        const double deviation = std::max(2e-4, 0.05 * truth * truth);  // not finer than the steps of the belief
        const CertifiedError s = sampled(truth * truth + deviation * normal(random), deviation, 100000);
        const BelievedError e = believed_error(kModel, &s);
        held += e.interval.low <= truth && truth <= e.interval.high;
    }
    EXPECT_NEAR(double(held) / trials, 0.95, 0.02);
}

TEST(BelievedError, IsComparedWithACertificateThatKnowsAnError) {
    Certificate certificate;
    CertifiedError known, unknown;
    known.error = 0.01;
    known.error_interval = {0.008, 0.012};
    unknown.cell = "V";
    unknown.error_interval = {0.0, 0.01};
    certificate.errors = {known, unknown};
    const Belief belief{{{"", 0.015, {0.01, 0.02}, 0.02}, {"V", 0.001, {0.0, 0.01}, 0.001}}, 10, 5};
    const nlohmann::ordered_json json = belief.to_json(&certificate);
    EXPECT_NEAR(json["picture"]["ratio"].get<double>(), 1.5, 1e-9);
    EXPECT_TRUE(json["cells"]["V"]["ratio"].is_null());
    EXPECT_FALSE(belief.to_json()["picture"].contains("ratio"));
    EXPECT_EQ(belief.ratios(certificate), "believed over certified: picture 1.50");
    EXPECT_EQ(belief.line(), "1.5 % (1 to 2 %); V 0.1 %");
}

}  // namespace
}  // namespace brisance
