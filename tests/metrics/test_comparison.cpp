// All measures together: halves, pixels that are not finite, and change from frame to frame.

#include "metrics/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "pictures.h"

namespace brisance {
namespace {

using testing::even_picture;
using testing::make_picture;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Picture fire(float scale, int offset = 0) {
    return make_picture(40, 30, [=](int x, int y) {
        const float distance = std::hypot(static_cast<float>(x - offset - 20), static_cast<float>(y - 15));
        return scale * Rgb(4.0f, 1.0f, 0.1f) * std::exp(-0.02f * distance * distance);
    });
}

TEST(Comparison, OfHalvesIsWithTheirMean) {
    const Comparison c = compare(fire(1.0f), {fire(0.9f), fire(1.1f)});
    EXPECT_NEAR(c.differences.rrmse, 0.0, 1e-6);
    EXPECT_NEAR(c.flip.mean, 0.0, 0.01);
    ASSERT_TRUE(c.halves);
    EXPECT_NEAR(c.halves->reference_noise, 0.1, 1e-6);
    EXPECT_EQ(c.halves->noise_free, 0.0);
    EXPECT_FALSE(compare(fire(1.0f), {fire(0.9f), std::nullopt}).halves);
}

TEST(Comparison, PixelsThatAreNoNumbersAreCountedAndNeverGood) {
    Picture image = fire(1.2f), first = fire(1.0f), second = fire(1.0f);
    image.pixels[10].y = kNan;
    image.pixels[620].x = kInfinity;
    first.pixels[620].z = -kInfinity;
    second.pixels[700] = Rgb(kNan);
    const Comparison c = compare(image, {first, second});
    EXPECT_EQ(c.not_finite.image, 2u);
    EXPECT_EQ(c.not_finite.reference, 2u);
    EXPECT_NEAR(c.differences.rrmse, 0.2, 1e-6);
    EXPECT_NEAR(c.differences.mean, 0.2, 1e-6);
    EXPECT_NEAR(c.halves->noise_free, 0.2, 1e-6);
    for (const std::size_t pixel : {10u, 620u, 700u})
        EXPECT_EQ(c.flip.errors.values[pixel], 1.0f);
    EXPECT_EQ(c.flip.mean, mean_of(c.flip.errors));
    // The rest of the map is that of the same pictures with black there.
    Picture patched = fire(1.2f), target = fire(1.0f);
    for (const std::size_t pixel : {10u, 620u, 700u})
        patched.pixels[pixel] = target.pixels[pixel] = Rgb(0.0f);
    EXPECT_EQ(c.flip.errors.values[300], compare(patched, {target, std::nullopt}).flip.errors.values[300]);
}

TEST(Comparison, NothingButNanIsWhollyDifferent) {
    const Comparison c = compare(even_picture(kNan), {even_picture(1.0f), std::nullopt});
    EXPECT_EQ(c.not_finite.image, 32u * 24u);
    EXPECT_EQ(c.flip.mean, 1.0);
}

TEST(Comparison, RefusesPicturesOfOtherSizes) {
    EXPECT_THROW(compare(even_picture(1.0f, 8, 8), {even_picture(1.0f, 8, 9), std::nullopt}), Error);
    EXPECT_THROW(compare(even_picture(1.0f, 8, 8), {even_picture(1.0f, 8, 8), even_picture(1.0f, 9, 8)}), Error);
}

TEST(TemporalError, IsBlindToWhatStaysWrong) {
    const auto frame = [](float error, int offset) {
        Picture image = fire(1.0f, offset);
        for (Rgb& pixel : image.pixels)
            pixel += Rgb(error);
        return FrameAndReference{image, {fire(1.0f, offset), std::nullopt}};
    };
    EXPECT_NEAR(compare_changes(frame(0.3f, 0), frame(0.3f, 3)).error, 0.0, 1e-6);
    EXPECT_GT(compare_changes(frame(0.3f, 0), frame(-0.3f, 3)).error, 0.5);  // flicker
}

TEST(TemporalError, OfAFrozenImageIsOne) {
    const FrameAndReference first{fire(1.0f), {fire(1.0f), std::nullopt}},
        second{fire(1.0f), {fire(1.0f, 5), std::nullopt}};
    EXPECT_NEAR(compare_changes(first, second).error, 1.0, 1e-12);
    EXPECT_FALSE(compare_changes(first, second).halves);
}

TEST(TemporalError, OfAStandingReferenceIsNoneOrInfinite) {
    const FrameAndReference still{fire(1.0f), {fire(1.0f), std::nullopt}},
        flicker{fire(1.1f), {fire(1.0f), std::nullopt}};
    EXPECT_EQ(compare_changes(still, still).error, 0.0);
    EXPECT_TRUE(std::isinf(compare_changes(still, flicker).error));
}

TEST(TemporalError, WithHalvesKnowsTheirNoise) {
    const auto frame = [](float a, float b, int offset) {
        return FrameAndReference{fire(1.0f, offset), {fire(a, offset), fire(b, offset)}};
    };
    const TemporalError error = compare_changes(frame(0.9f, 1.1f, 0), frame(1.1f, 0.9f, 3));
    EXPECT_NEAR(error.error, 0.0, 1e-6);
    ASSERT_TRUE(error.halves);
    EXPECT_GT(error.halves->reference_noise, 0.05);
    EXPECT_EQ(error.halves->noise_free, 0.0);
    EXPECT_THROW(compare_changes(frame(1.0f, 1.0f, 0), {fire(1.0f), {fire(1.0f), std::nullopt}}), Error);
}

TEST(TemporalError, CountsPixelsThatAreNoNumbersInEitherFrame) {
    FrameAndReference first{fire(1.0f), {fire(1.0f), std::nullopt}},
        second{fire(1.0f, 3), {fire(1.0f, 3), std::nullopt}};
    first.image.pixels[0].x = kNan;
    second.image.pixels[7].x = kNan;
    second.reference.first.pixels[7].x = kInfinity;
    const TemporalError error = compare_changes(first, second);
    EXPECT_EQ(error.not_finite.image, 2u);
    EXPECT_EQ(error.not_finite.reference, 1u);
    EXPECT_EQ(error.error, 0.0);
}

}  // namespace
}  // namespace brisance
