// Errors as single numbers: computed by hand where possible, and from known statistics where noise matters.

#include "metrics/differences.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace brisance {
namespace {

using Pixels = std::vector<Rgb>;

Pixels scaled(Pixels pixels, float factor) {
    for (Rgb& pixel : pixels)
        pixel *= factor;
    return pixels;
}

Pixels ramp(std::size_t count) {
    Pixels pixels;
    for (std::size_t i = 0; i < count; ++i)
        pixels.emplace_back(0.5f + static_cast<float>(i % 97), 1.0f + static_cast<float>(i % 13), 2.0f);
    return pixels;
}

// With independent normal noise of `sigma` in every channel.
Pixels noisy(Pixels pixels, double sigma, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal(0.0f, static_cast<float>(sigma));
    for (Rgb& pixel : pixels)
        for (int c = 0; c < 3; ++c)
            pixel[c] += normal(generator);
    return pixels;
}

TEST(Differences, EqualPicturesHaveNone) {
    const Differences d = measure_differences(ramp(2000), ramp(2000));
    EXPECT_EQ(d.rrmse, 0.0);
    EXPECT_EQ(d.relmse, 0.0);
    EXPECT_EQ(d.mape, 0.0);
    EXPECT_EQ(d.mean, 0.0);
}

TEST(Differences, OfTwoPixelsByHand) {
    const Pixels image = {{3.0f, 0.0f, 0.0f}, {0.0f, 5.0f, 1.0f}};
    const Pixels reference = {{1.0f, 2.0f, 0.0f}, {0.0f, 4.0f, 2.0f}};
    const Differences d = measure_differences(image, reference);
    const double epsilon = 0.01 * 9.0 / 6.0;
    const auto square = [&](double difference, double r) {
        return difference * difference / (r * r + epsilon * epsilon);
    };
    const auto magnitude = [&](double difference, double r) { return difference / (r + epsilon); };
    EXPECT_NEAR(d.epsilon, epsilon, 1e-15);
    EXPECT_NEAR(d.rrmse, std::sqrt(10.0 / 25.0), 1e-15);
    EXPECT_NEAR(d.relmse, (square(2, 1) + square(2, 2) + square(1, 4) + square(1, 2)) / 6.0, 1e-12);
    EXPECT_NEAR(d.mape, (magnitude(2, 1) + magnitude(2, 2) + magnitude(1, 4) + magnitude(1, 2)) / 6.0, 1e-12);
    EXPECT_NEAR(d.mean, 0.0, 1e-15);
    EXPECT_EQ(d.trimmed, 0u);
}

TEST(Differences, DoNotDependOnTheUnitOfRadiance) {
    const Pixels reference = ramp(5000), image = noisy(reference, 0.3, 1);
    const Differences d = measure_differences(image, reference);
    for (const float factor : {1.0f / 65536.0f, 1024.0f}) {
        const Differences other = measure_differences(scaled(image, factor), scaled(reference, factor));
        EXPECT_NEAR(other.rrmse, d.rrmse, 1e-12);
        EXPECT_NEAR(other.relmse, d.relmse, 1e-12);
        EXPECT_NEAR(other.mape, d.mape, 1e-12);
        EXPECT_NEAR(other.mean, d.mean, 1e-12);
    }
}

TEST(Differences, OfAWholePictureThatIsTooBright) {
    const Differences d = measure_differences(scaled(ramp(1000), 1.25f), ramp(1000));
    EXPECT_NEAR(d.rrmse, 0.25, 1e-12);
    EXPECT_NEAR(d.mean, 0.25, 1e-12);
    EXPECT_GT(d.mape, 0.2);
    EXPECT_LT(d.mape, 0.25);  // epsilon in the denominator
    EXPECT_NEAR(measure_differences(scaled(ramp(1000), 0.75f), ramp(1000)).mean, -0.25, 1e-12);
}

TEST(Differences, RelMseForgivesOnePixelInAThousand) {
    const Pixels reference = ramp(10000);
    Pixels image = reference;
    for (std::size_t i = 0; i < 10; ++i)
        image[997 * i] += Rgb(1e6f);
    const Differences forgiven = measure_differences(image, reference);
    EXPECT_EQ(forgiven.trimmed, 10u);
    EXPECT_EQ(forgiven.relmse, 0.0);
    EXPECT_GT(forgiven.rrmse, 100.0);
    image[5] += Rgb(1e3f);  // the eleventh, and the least of them
    EXPECT_GT(measure_differences(image, reference).relmse, 0.0);
}

TEST(Differences, LightWhereThereShouldBeNoneIsInfinitelyWrong) {
    const Pixels black(10, Rgb(0.0f)), light(10, Rgb(0.1f));
    const Differences d = measure_differences(light, black);
    EXPECT_TRUE(std::isinf(d.rrmse));
    EXPECT_TRUE(std::isinf(d.relmse));
    EXPECT_TRUE(std::isinf(d.mape));
    EXPECT_TRUE(std::isinf(d.mean));
    EXPECT_EQ(measure_differences(black, black).rrmse, 0.0);
    EXPECT_EQ(measure_differences(black, black).relmse, 0.0);
    EXPECT_EQ(measure_differences(light, light).mape, 0.0);
}

// With R = 2 everywhere and noise of 0.4 in each half: the mean's noise is 0.4 / sqrt(2) / 2 of the reference.
TEST(Halves, TellTheReferencesNoise) {
    const Pixels truth(40000, Rgb(2.0f));
    const HalvesDifferences d = measure_halves(truth, noisy(truth, 0.4, 2), noisy(truth, 0.4, 3));
    EXPECT_NEAR(d.reference_noise, 0.2 / std::sqrt(2.0), 0.002);
}

// The image is 3 % too bright: far below the noise of 14 % of what judges it. The cross product's standard error is
// about sigma^2 / sqrt(samples) / R^2 = 1.2e-4 on a squared error of 9e-4.
TEST(Halves, SeeTheImagesErrorBelowTheReferencesNoise) {
    const Pixels truth(40000, Rgb(2.0f));
    const Pixels a = noisy(truth, 0.4, 2), b = noisy(truth, 0.4, 3);
    const Pixels image = scaled(truth, 1.03f);
    const HalvesDifferences d = measure_halves(image, a, b);
    EXPECT_NEAR(d.noise_free * d.noise_free, 9e-4, 4.0 * 1.2e-4);
    Pixels mean = a;
    for (std::size_t i = 0; i < mean.size(); ++i)
        mean[i] = 0.5f * (a[i] + b[i]);
    const double noisy_error = measure_differences(image, mean).rrmse;
    EXPECT_NEAR(noisy_error, std::hypot(0.03, 0.2 / std::sqrt(2.0)), 0.003);
    EXPECT_TRUE(below_noise(noisy_error, d.reference_noise));
    EXPECT_FALSE(below_noise(measure_differences(scaled(truth, 1.4f), mean).rrmse, d.reference_noise));
}

TEST(Halves, ErrorsThatChanceMakesNegativeAreZero) {
    const Pixels image = {{1.0f, 1.0f, 1.0f}}, a = {{1.1f, 1.1f, 1.1f}}, b = {{0.9f, 0.9f, 0.9f}};
    EXPECT_EQ(measure_halves(image, a, b).noise_free, 0.0);
    EXPECT_NEAR(measure_halves(image, a, b).reference_noise, 0.1, 1e-6);
}

TEST(Halves, WithoutNoiseGiveTheOrdinaryError) {
    const Pixels reference = ramp(100), image = noisy(reference, 0.1, 4);
    EXPECT_NEAR(measure_halves(image, reference, reference).noise_free, measure_differences(image, reference).rrmse,
                1e-12);
}

}  // namespace
}  // namespace brisance
