// The error that changes against the motion, and the spectrum of errors over time: closed forms.

#include "metrics/flicker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "core/error.h"
#include "metrics/temporal_spectrum.h"
#include "pictures.h"

namespace brisance {
namespace {

using testing::even_picture;
using testing::make_picture;

constexpr int kWidth = 48, kHeight = 32;

float wave(double x, double y) {
    return static_cast<float>(std::sin(0.21 * x + 0.1) * std::cos(0.17 * y));
}

// A reference of 1, and an error that has moved `by` pixels to the right.
FrameAndReference travelling(double by, float scale = 0.1f) {
    const Picture reference = even_picture(1.0f, kWidth, kHeight);
    return {make_picture(kWidth, kHeight, [&](int x, int y) { return Rgb(1.0f + scale * wave(x - by, y)); }),
            {reference, std::nullopt}};
}

Plane even_plane(float value) {
    return {kWidth, kHeight, std::vector<float>(std::size_t(kWidth) * kHeight, value)};
}

// As write_exr makes it: an eye at `x` [m] that looks along -z; a pixel is `angle` wide per metre of depth.
dmat4 ndc_of_eye_at(double x, double angle) {
    dmat4 ndc(0.0);
    ndc[0][0] = 1.0 / (angle * kWidth);
    ndc[1][1] = -1.0 / (angle * kHeight);
    ndc[2] = glm::dvec4(0.5, 0.5, 1.0, 1.0);
    ndc[3][2] = -1.0;
    dmat4 flip(1.0);
    flip[2][2] = -1.0;
    return ndc * flip * glm::translate(dmat4(1.0), dvec3(-x, 0.0, 0.0));
}

TEST(Flicker, OfAnErrorThatTravelsWithTheMotionIsNone) {
    const Flicker f =
        measure_flicker(travelling(0.0), travelling(3.0), motion_of_vectors(even_plane(-3), even_plane(0)));
    EXPECT_NEAR(f.error, 0.0, 1e-6);
    EXPECT_NEAR(f.seen, 1.0 - 3.0 / kWidth, 1e-9);
    EXPECT_FALSE(f.halves);
    // Between pixels all that is left is what linear interpolation misses of a wave of thirty pixels.
    const Flicker between =
        measure_flicker(travelling(0.0), travelling(2.5), motion_of_vectors(even_plane(-2.5f), even_plane(0)));
    EXPECT_LT(between.error, 0.01 * 0.1);
}

TEST(Flicker, OfAnErrorThatStaysWhileThePictureMovesIsItsChange) {
    // By half its period: what was +e is -e.
    const double half = 3.14159265358979 / 0.21;
    const Picture reference = even_picture(1.0f, kWidth, kHeight);
    double expected = 0.0;
    std::size_t count = 0;
    const int by = static_cast<int>(std::lround(half));
    for (int y = 0; y < kHeight; ++y)
        for (int x = by; x < kWidth; ++x, ++count)
            expected += std::pow(0.1 * double(wave(x, y) - wave(x - by, y)), 2);
    const Flicker f = measure_flicker(travelling(0.0), travelling(0.0),
                                      motion_of_vectors(even_plane(static_cast<float>(-by)), even_plane(0)));
    EXPECT_NEAR(f.error, std::sqrt(expected / double(count)), 1e-6);
    EXPECT_GT(f.error, 0.05);
}

// White noise that is new in each frame has twice its variance in the difference of two.
TEST(Flicker, OfNewNoiseInEachFrameIsRootTwoOfIt) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal(0.0f, 0.1f);
    const auto noisy = [&] {
        const Picture image = make_picture(128, 128, [&](int, int) { return Rgb(1.0f + normal(random)); });
        return FrameAndReference{image, {even_picture(1.0f, 128, 128), std::nullopt}};
    };
    const FrameAndReference first = noisy(), second = noisy();
    const Plane zero{128, 128, std::vector<float>(128 * 128, 0.0f)};
    // 16384 pixels: the root of the mean square is known to 0.6 %, four times that are allowed.
    EXPECT_NEAR(measure_flicker(first, second, motion_of_vectors(zero, zero)).error, 0.1 * std::sqrt(2.0), 0.0034);
    EXPECT_NEAR(measure_flicker(first, first, motion_of_vectors(zero, zero)).error, 0.0, 1e-9);
}

TEST(Flicker, WithHalvesIsFreeOfTheirNoise) {
    std::mt19937 random(6);
    std::normal_distribution<float> normal(0.0f, 0.2f);
    const auto half = [&] { return make_picture(128, 128, [&](int, int) { return Rgb(1.0f + normal(random)); }); };
    const Picture image = even_picture(1.0f, 128, 128), brighter = even_picture(1.1f, 128, 128);
    const Plane zero{128, 128, std::vector<float>(128 * 128, 0.0f)};
    const FrameAndReference first{image, {half(), half()}}, second{brighter, {half(), half()}};
    const Flicker f = measure_flicker(first, second, motion_of_vectors(zero, zero));
    ASSERT_TRUE(f.halves);
    // The product of two changes of noise, 0.08, over 128 squared pixels: 0.0006 beside 0.01.
    EXPECT_NEAR(f.halves->noise_free, 0.1, 0.0125);
    EXPECT_NEAR(f.halves->reference_noise, 0.2, 0.005);  // sqrt(2) of the mean of two halves
    EXPECT_GT(f.error, 0.19);
}

// Pairs of frames count by their light, and together they know what is below the noise of each.
TEST(Flicker, OfASequenceIsThatOfAllItsPairs) {
    const auto pair = [](float level, float change) {
        const auto frame = [&](float error) {
            return FrameAndReference{even_picture(level + error, kWidth, kHeight),
                                     {even_picture(level, kWidth, kHeight), std::nullopt}};
        };
        return measure_flicker(frame(0.0f), frame(change), motion_of_vectors(even_plane(0), even_plane(0)));
    };
    FlickerSums sums = pair(1.0f, 0.3f).sums;
    sums.add(pair(3.0f, 0.1f).sums);
    EXPECT_NEAR(flicker_of(sums, false).error, std::sqrt((0.09 + 0.01) / (1.0 + 9.0)), 1e-6);
    EXPECT_EQ(flicker_of(sums, false).seen, 1.0);
}

TEST(Flicker, LeavesOutWhatIsNotFinite) {
    FrameAndReference first = travelling(0.0), second = travelling(0.0);
    first.image.pixels[50].x = std::numeric_limits<float>::quiet_NaN();
    second.image.pixels[60].x = std::numeric_limits<float>::infinity();
    const Flicker f = measure_flicker(first, second, motion_of_vectors(even_plane(0), even_plane(0)));
    EXPECT_EQ(f.not_finite.image, 2u);
    EXPECT_EQ(f.error, 0.0);
    EXPECT_THROW(measure_flicker(first, second,
                                 motion_of_vectors({4, 4, std::vector<float>(16)}, {4, 4, std::vector<float>(16)})),
                 Error);
}

TEST(CameraMotion, OfACameraThatMovesSidewaysFollowsTheDepth) {
    constexpr double kAngle = 0.01;  // a pixel at 10 m is 0.1 m wide
    const SeenFrame before{even_plane(10.0f), ndc_of_eye_at(0.0, kAngle)};
    const SeenFrame now{even_plane(10.0f), ndc_of_eye_at(0.2, kAngle)};
    const Motion motion = camera_motion(now, before);
    // The eye went 0.2 m to the right: what is seen went two pixels to the left, and was two to the right.
    EXPECT_NEAR(motion.before[5 * kWidth + 7].x, 7.5 + 2.0, 1e-9);
    EXPECT_NEAR(motion.before[5 * kWidth + 7].y, 5.5, 1e-9);
    EXPECT_TRUE(std::isnan(motion.before[5 * kWidth + kWidth - 1].x));  // came into the picture
    // The sky, far away, stands still.
    const SeenFrame sky{even_plane(1e10f), ndc_of_eye_at(0.0, kAngle)},
        later{even_plane(1e10f), ndc_of_eye_at(0.2, kAngle)};
    EXPECT_NEAR(camera_motion(later, sky).before[5 * kWidth + 7].x, 7.5, 1e-6);
}

TEST(CameraMotion, KnowsWhatWasHidden) {
    SeenFrame before{even_plane(10.0f), ndc_of_eye_at(0.0, 0.01)};
    const SeenFrame now{even_plane(10.0f), ndc_of_eye_at(0.0, 0.01)};
    before.depth.values[3 * kWidth + 4] = 4.0f;  // something nearer stood there
    const Motion motion = camera_motion(now, before);
    EXPECT_TRUE(std::isnan(motion.before[3 * kWidth + 4].x));
    EXPECT_NEAR(motion.before[3 * kWidth + 5].x, 5.5, 1e-9);
    EXPECT_THROW(camera_motion({even_plane(1.0f), dmat4(0.0)}, before), Error);
}

TemporalSpectrum spectrum_of(int frames, const std::function<float(int frame, int x, int y)>& error) {
    ErrorOverTime errors;
    for (int t = 0; t < frames; ++t)
        errors.add({make_picture(kWidth, kHeight, [&](int x, int y) { return Rgb(1.0f + error(t, x, y)); }),
                    {even_picture(1.0f, kWidth, kHeight), std::nullopt}});
    return errors.spectrum();
}

TEST(TemporalSpectrum, OfWhiteNoiseIsFlatAndAddsUpToTheError) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal(0.0f, 0.1f);
    double square = 0.0;
    const TemporalSpectrum s = spectrum_of(16, [&](int, int, int) {
        const float e = normal(random);
        square += double(e) * e;
        return e;
    });
    double sum = 0.0;
    // 4608 values each: the power at a frequency is known to 2 % (a gray picture's channels are equal: 1536 values, 3.6
    // %); five times that are allowed.
    for (std::size_t k = 0; k < 16; ++k) {
        EXPECT_NEAR(s.power[k], 0.01 / 16.0, 0.18 * 0.01 / 16.0) << k;
        EXPECT_EQ(s.cycles_per_frame[k], double(k) / 32.0);
        sum += s.power[k];
    }
    EXPECT_NEAR(sum, square / (16.0 * kWidth * kHeight), 1e-6);
    const auto bands = s.bands();  // 1, 3, 5 and 7 of 16 frequencies
    EXPECT_NEAR(bands[0], 0.1 * std::sqrt(1.0 / 16.0), 0.003);
    EXPECT_NEAR(bands[1], 0.1 * std::sqrt(3.0 / 16.0), 0.003);
    EXPECT_NEAR(bands[2], 0.1 * std::sqrt(5.0 / 16.0), 0.003);
    EXPECT_NEAR(bands[3], 0.1 * std::sqrt(7.0 / 16.0), 0.003);
}

TEST(TemporalSpectrum, KnowsWhatStandsWhatDriftsAndWhatAlternates) {
    const auto still = spectrum_of(12, [](int, int x, int) { return 0.01f * float(x % 3); }).bands();
    EXPECT_GT(still[0], 0.01);
    EXPECT_NEAR(still[1] + still[2] + still[3], 0.0, 1e-6);
    const auto drift = spectrum_of(12, [](int t, int, int) { return 0.01f * (float(t) - 5.5f); }).bands();
    EXPECT_NEAR(drift[0], 0.0, 1e-6);
    EXPECT_GT(drift[1], 20.0 * drift[3]);  // a ramp's mirror image has no step
    const auto alternating = spectrum_of(12, [](int t, int, int) { return t % 2 == 0 ? 0.1f : -0.1f; }).bands();
    EXPECT_NEAR(alternating[0], 0.0, 1e-6);
    EXPECT_GT(alternating[3], 0.097);
    EXPECT_LT(alternating[1], 0.02);
    // A basis function has all its power at one frequency.
    const TemporalSpectrum pure = spectrum_of(12, [](int t, int, int) {
        return 0.1f * static_cast<float>(std::cos(3.14159265358979 * 5 * (t + 0.5) / 12.0));
    });
    EXPECT_NEAR(pure.power[5], 0.005, 1e-7);
    EXPECT_NEAR(pure.power[4], 0.0, 1e-7);
}

TEST(TemporalSpectrum, WithHalvesIsFreeOfTheirNoise) {
    std::mt19937 random(8);
    std::normal_distribution<float> normal(0.0f, 0.3f);
    const auto half = [&] {
        return make_picture(kWidth, kHeight, [&](int, int) {
            return Rgb(1.0f + normal(random), 1.0f + normal(random), 1.0f + normal(random));
        });
    };
    ErrorOverTime errors;
    for (int t = 0; t < 8; ++t)
        errors.add({even_picture(t % 2 == 0 ? 1.1f : 0.9f, kWidth, kHeight), {half(), half()}});
    const TemporalSpectrum s = errors.spectrum();
    EXPECT_NEAR(s.bands()[3], 0.1, 0.01);
    EXPECT_LT(s.bands()[0], 0.02);
    EXPECT_GT(std::sqrt(s.power[0]), 0.06);  // the reference's noise, an eighth of its power
}

TEST(TemporalSpectrum, OfLargePicturesIsThatOfALatticeOfPixels) {
    ErrorOverTime errors;
    for (int t = 0; t < 2; ++t)
        errors.add({even_picture(1.1f, 400, 300), {even_picture(1.0f, 400, 300), std::nullopt}});
    const TemporalSpectrum s = errors.spectrum();
    EXPECT_LE(s.pixels, kSpectrumPixels);
    EXPECT_GE(s.pixels, kSpectrumPixels / 4);
    EXPECT_NEAR(s.bands()[0], 0.1, 1e-6);
    EXPECT_THROW(errors.add({even_picture(1.0f, 8, 8), {even_picture(1.0f, 8, 8), std::nullopt}}), Error);
}

}  // namespace
}  // namespace brisance
