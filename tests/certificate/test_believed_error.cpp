// What is believed of an error: a model's expectation and few samples together.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "certificate/believed_error.h"

namespace brisance {
namespace {

const ExpectedError kModel{"", 0.02, 0.7};

CertifiedError sampled(double error_square, double deviation, std::size_t strata = 100) {
    CertifiedError e;
    e.square = error_square;
    e.error = std::sqrt(std::max(0.0, error_square));
    e.square_deviation = deviation;
    e.strata = strata;
    return e;
}

TEST(BelievedError, IsTheModelsWithoutSamples) {
    const BelievedError e = believed_error(kModel, nullptr);
    EXPECT_NEAR(e.error, 0.02, 2e-4);
    EXPECT_NEAR(e.interval.low, 0.02 * std::exp(-1.96 * 0.7), 2e-4);
    EXPECT_NEAR(e.interval.high, 0.02 * std::exp(1.96 * 0.7), 2e-3);
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

TEST(BelievedError, IgnoresSamplesThatSayNothing) {
    const CertifiedError nothing;
    EXPECT_EQ(believed_error(kModel, &nothing).error, believed_error(kModel, nullptr).error);
    EXPECT_EQ(believed_error({"", 0.0, 0.7}, &nothing).error, 0.0);
}

// Where errors are as the model says, 95 % of the intervals hold the truth: 4 standard errors of 2000 trials are 2 %.
TEST(BelievedError, ItsIntervalHoldsTheTruth) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    int held = 0;
    constexpr int trials = 2000;
    for (int k = 0; k < trials; ++k) {
        const double truth = kModel.error * std::exp(kModel.spread * normal(random));
        const CertifiedError s = sampled(truth * truth + 2e-4 * normal(random), 2e-4, 100000);
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
