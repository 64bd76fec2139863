// A residual that is known with noise is found where it is smooth, and noise is not taken for it.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "correction/residual_pyramid.h"

namespace brisance::test_residual_pyramid {
namespace {

constexpr int kWidth = 96, kHeight = 64;
constexpr std::size_t kPixels = std::size_t(kWidth) * kHeight;
constexpr Stream kNoise = stream_of("tests/correction/noise");

double noise(int estimate, std::size_t pixel) {
    Rng rng(kNoise, pixel, std::uint64_t(estimate));
    return std::sqrt(12.0) * (rng.next_double() - 0.5);  // of variance 1
}

// Waves some thirty pixels long.
float wave(std::size_t pixel) {
    const double x = double(pixel % kWidth), y = double(pixel / kWidth);
    return float(std::sin(0.2 * x) * std::cos(0.15 * y) + 0.5);
}

NoisyResidual residual(float of_wave, float of_noise) {
    NoisyResidual out{kWidth, kHeight, {}, std::vector<float>(kPixels, 1.0f)};
    for (int k = 0; k < 2; ++k)
        for (std::size_t p = 0; p < kPixels; ++p)
            out.estimates[k].push_back(Rgb(of_wave * wave(p) + of_noise * float(noise(k, p))));
    return out;
}

double mean_square(const std::vector<Rgb>& values, float of_wave) {
    double sum = 0.0;
    for (std::size_t p = 0; p < kPixels; ++p)
        sum += std::pow(double(values[p].x) - of_wave * wave(p), 2) / kPixels;
    return sum;
}

TEST(ResidualPyramid, KeepsWhatIsKnownWithoutNoise) {
    const SmoothResidual smooth = smooth_residual(residual(1.0f, 0.0f));
    EXPECT_LT(mean_square(smooth.values, 1.0f), 1e-10);
    for (const ResidualBand& band : smooth.bands)
        EXPECT_NEAR(band.gain(), 1.0, 1e-9);
}

TEST(ResidualPyramid, TakesNoNoiseForAResidual) {
    const SmoothResidual smooth = smooth_residual(residual(0.0f, 1.0f));
    // The mean of both estimates has a mean square of 0.5; a hundredth of it is what gains that chance puts above 0
    // let through (measured: 0.002).
    EXPECT_LT(mean_square(smooth.values, 0.0f), 0.005);
}

TEST(ResidualPyramid, FindsASmoothResidualBelowItsNoise) {
    // Mean squares: the residual's 0.5, of the noise in the mean of both estimates 4.5.
    const SmoothResidual smooth = smooth_residual(residual(1.0f, 3.0f));
    const double error = mean_square(smooth.values, 1.0f);
    EXPECT_LT(error, 0.08);                       // measured: 0.072, and 0.088 if bands were taken to be apart
    EXPECT_LT(smooth.bands.front().gain(), 0.1);  // single pixels are noise
    double left = 0.0;
    for (const ResidualBand& band : smooth.bands)
        left += band.left(1.0) / (3.0 * kPixels);
    // What it says of its own error: bands overlap, so that their squares do not quite add up.
    EXPECT_GT(left, error / 3.0);
    EXPECT_LT(left, error * 2.0);
}

TEST(ResidualPyramid, PutsNothingWhereTheWeightIsZero) {
    NoisyResidual half = residual(1.0f, 0.0f);
    for (std::size_t p = 0; p < kPixels; ++p)
        if (p % kWidth < kWidth / 2) {
            half.weight[p] = 0.0f;
            half.estimates[0][p] = half.estimates[1][p] = Rgb(0.0f);
        }
    const SmoothResidual smooth = smooth_residual(half);
    for (std::size_t p = 0; p < kPixels; ++p)
        EXPECT_NEAR(smooth.values[p].x, p % kWidth < kWidth / 2 ? 0.0f : wave(p), 1e-5f);
}

TEST(ResidualPyramid, ScalesWithTheWeight) {
    // Light that is everywhere off by a tenth: the residual relative to the weight is even, whatever the weight is.
    NoisyResidual tenth{kWidth, kHeight, {}, {}};
    for (std::size_t p = 0; p < kPixels; ++p) {
        tenth.weight.push_back(p / kWidth % 7 == 0 ? 5.0f : 0.1f);
        for (int k = 0; k < 2; ++k)
            tenth.estimates[k].push_back(Rgb(tenth.weight[p] * (0.1f + 0.2f * float(noise(k, p)))));
    }
    const SmoothResidual smooth = smooth_residual(tenth);
    for (std::size_t p = 0; p < kPixels; p += 17)
        EXPECT_NEAR(smooth.values[p].x / tenth.weight[p], 0.1f, 0.05f);
}

TEST(ResidualPyramid, MoreSamplesLeaveLess) {
    const ResidualBand band{{{2.0, 3.0}}};
    EXPECT_NEAR(band.gain(), 0.4, 1e-12);
    EXPECT_NEAR(band.left(), 2.0 * 0.6, 1e-12);  // Wiener: residual (1 - gain)
    EXPECT_NEAR(band.left(3.0), 2.0 * 1.0 / 3.0, 1e-12);
    EXPECT_EQ((ResidualBand{{{-1.0, 3.0}}}).gain(), 0.0);
    EXPECT_EQ((ResidualBand{{{-1.0, 3.0}}}).left(), 0.0);
}

// What may be chance does not move the picture, and more samples may tell.
TEST(ResidualPyramid, TakesNoChanceForAResidual) {
    const ResidualEnergy chance{2.0, 3.0, 1.1}, known{2.0, 3.0, 0.2};
    EXPECT_EQ(chance.gain(), 0.0);  // less than two standard deviations
    EXPECT_GT(chance.gain(2.0), 0.0);
    EXPECT_NEAR(known.known(), 2.0 - 4.0 * 0.2 / 2.0, 1e-12);
    EXPECT_NEAR(known.gain(), 1.6 / 4.6, 1e-12);
}

double known(const std::vector<ResidualBand>& bands) {
    double sum = 0.0;
    for (const ResidualBand& band : bands)
        sum += band.known();
    return sum;
}

double square_of(const SmoothResidual& smooth) {
    return mean_square(smooth.values, 0.0f);
}

// With noise of a tenth of the residual, whose mean square is 0.5, over three channels.
TEST(ResidualPyramid, TakesNoMoreThanIsBelieved) {
    const NoisyResidual clear = residual(1.0f, 0.1f);
    double seen = 0.0;
    const SmoothResidual all = smooth_residual(clear, [&](const std::vector<ResidualBand>& bands) {
        seen = known(bands);
        return 10.0 * seen;
    });
    EXPECT_GT(seen / (3.0 * kPixels), 0.25);  // of 0.5: borders, and the overlap of long waves, count for too little
    EXPECT_LT(seen / (3.0 * kPixels), 0.5);
    EXPECT_EQ(all.values, smooth_residual(clear).values);
    const double some = 1e-7 * seen;
    const SmoothResidual little = smooth_residual(clear, [&](const auto&) { return some; });
    EXPECT_NEAR(known(little.bands), some, 1e-9 * some);
    EXPECT_LT(square_of(little), 0.01 * square_of(all));
    EXPECT_EQ(square_of(smooth_residual(clear, [](const auto&) { return 0.0; })), 0.0);
}

// One sample for 64 pixels: three octaves of wavelength are one band of which nothing is known. The waves are found
// nevertheless, and no light is lost between the bands.
TEST(ResidualPyramid, TellsNoBandsApartThatHaveNoSamples) {
    NoisyResidual few = residual(1.0f, 0.2f);
    const SmoothResidual all = smooth_residual(few);
    few.samples = double(kPixels) / 64.0;
    const SmoothResidual some = smooth_residual(few);
    ASSERT_EQ(some.bands.size() + 2, all.bands.size());
    EXPECT_EQ(some.bands[0].levels, 3.0);
    EXPECT_EQ(some.bands[0].known(), 0.0);
    double found = 0.0, product = 0.0;
    for (const ResidualBand& band : some.bands)
        found += band.sum().residual;
    for (std::size_t p = 0; p < kPixels; ++p)
        product += glm::dot(few.estimates[0][p], few.estimates[1][p]);
    EXPECT_NEAR(found, product, 1e-3 * product);
    EXPECT_LT(mean_square(some.values, 1.0f), 0.25);  // of 0.5
}

TEST(ResidualPyramid, TakesSumsOverTheirDivisor) {
    NoisyResidual sums = residual(1.0f, 0.5f);
    const SmoothResidual means = smooth_residual(sums);
    sums.divisor = 8.0;
    for (std::vector<Rgb>& estimate : sums.estimates)
        for (Rgb& value : estimate)
            value *= 8.0f;
    EXPECT_EQ(smooth_residual(sums).values, means.values);
}

// Small pictures have few levels or one.
TEST(ResidualPyramid, TakesPicturesOfAnySize) {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 50), std::pair(5, 4), std::pair(17, 9)}) {
        NoisyResidual even{width, height, {}, std::vector<float>(std::size_t(width) * height, 2.0f)};
        for (std::vector<Rgb>& estimate : even.estimates)
            estimate.assign(even.weight.size(), Rgb(0.25f));
        for (const Rgb& value : smooth_residual(even).values)
            EXPECT_NEAR(value.x, 0.25f, 1e-5f);
    }
}

// One bright path beside a picture that is far brighter: what it adds stays in proportion to the light around it.
TEST(ResidualPyramid, LeavesNoGrainsInTheDark) {
    constexpr float kDark = 0.01f;
    NoisyResidual grain = residual(1.0f, 2.0f);
    for (std::size_t p = 0; p < kPixels; ++p) {
        const bool dark = p % kWidth >= kWidth / 2;
        grain.weight[p] = dark ? kDark : 1.0f;
        // Both estimates know of detail as fine as pixels.
        for (std::vector<Rgb>& estimate : grain.estimates)
            estimate[p] = (dark ? kDark * kDark : 1.0f) * (estimate[p] + Rgb(float(noise(2, p))));
    }
    const std::size_t at = (kHeight / 2) * kWidth + 3 * kWidth / 4;
    grain.estimates[0][at] = Rgb(1.0f);
    const SmoothResidual smooth = smooth_residual(grain);
    EXPECT_GT(smooth.bands[0].gain(), 0.2);
    EXPECT_LT(glm::length(smooth.values[at]), 0.03f);  // it would be 0.2
}

// A dim floor beside a fire: samples tell every pixel of the fire and nothing of the floor, and leave it as it is.
TEST(ResidualPyramid, LeavesADimFloorBesideAFire) {
    constexpr float kDim = 0.01f;
    NoisyResidual picture{kWidth, kHeight, {}, std::vector<float>(kPixels, 1.0f)};
    const auto dim = [](std::size_t p) { return p / kWidth >= kHeight / 2; };
    for (std::size_t p = 0; p < kPixels; ++p) {
        if (dim(p))
            picture.weight[p] = kDim;
        for (int k = 0; k < 2; ++k) {
            // Of the floor's light, a twentieth of the samples have all.
            const double of_fire = 0.1 * noise(2, p) + 0.05 * noise(k, p),
                         of_floor = kDim * (noise(k, p) > 0.9 * std::sqrt(3.0) ? 19.0 : -1.0);
            picture.estimates[k].push_back(Rgb(float(dim(p) ? of_floor : of_fire)));
        }
    }
    const SmoothResidual smooth = smooth_residual(picture);
    double fire = 0.0, floor = 0.0;
    for (std::size_t p = 0; p < kPixels; ++p)
        if (dim(p))
            floor += std::pow(smooth.values[p].x / kDim, 2) / (kPixels / 2);
        else
            fire += std::pow(smooth.values[p].x - 0.1 * noise(2, p), 2) / (kPixels / 2);
    EXPECT_LT(std::sqrt(fire), 0.05);   // half of its error
    EXPECT_LT(std::sqrt(floor), 0.05);  // one gain for all leaves 1.1
}

}  // namespace
}  // namespace brisance::test_residual_pyramid
