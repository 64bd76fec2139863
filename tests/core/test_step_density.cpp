#include "core/step_density.h"

#include <gtest/gtest.h>

namespace brisance {
namespace {

StepDensity with_a_gap() {
    StepDensity d;
    d.add(1.0, 1.5, 1.0);
    d.add(1.5, 2.0, 0.0);
    d.add(2.0, 4.0, 3.0);
    return d;
}

TEST(StepDensity, IntegratesToOne) {
    const StepDensity d = with_a_gap();
    double sum = 0.0;
    constexpr int kPoints = 5000;
    for (int i = 0; i < kPoints; ++i)
        sum += d.pdf((i + 0.5) / kPoints * 5.0) * 5.0 / kPoints;
    EXPECT_NEAR(sum, 1.0, 1e-3);
    EXPECT_EQ(d.pdf(1.7), 0.0);
    EXPECT_EQ(d.pdf(0.5), 0.0);
    EXPECT_EQ(d.pdf(4.5), 0.0);
}

// Evenly spaced numbers give samples whose shares are those of the steps.
TEST(StepDensity, SamplesByItsPdf) {
    const StepDensity d = with_a_gap();
    double mean = 0.0, first = 0.0;
    constexpr int kPoints = 4000;
    for (int i = 0; i < kPoints; ++i) {
        const double t = d.sample((i + 0.5) / kPoints);
        EXPECT_GT(d.pdf(t), 0.0);
        mean += t / kPoints;
        first += (t < 1.5) / double(kPoints);
    }
    EXPECT_NEAR(first, 0.25, 1e-3);
    EXPECT_NEAR(mean, 0.25 * 1.25 + 0.75 * 3.0, 1e-3);
}

}  // namespace
}  // namespace brisance
