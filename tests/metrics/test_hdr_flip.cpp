// FLIP over the exposures of a reference.

#include "metrics/hdr_flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pictures.h"

namespace brisance {
namespace {

using testing::even_picture;
using testing::make_picture;

// Narkowicz' curve with its exposure of 0.6.
double aces(double x) {
    x *= 0.6;
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

// Pixel values between 1/4 in the dark two thirds and 8 in the bright rest.
Picture two_lights(float dark = 0.25f, float bright = 8.0f) {
    return make_picture(48, 32, [=](int x, int) { return Rgb(x < 32 ? dark : bright); });
}

TEST(HdrFlipExposures, GoFromTheBrightestToTheMedian) {
    const Exposures e = hdr_flip_exposures(two_lights());
    EXPECT_NEAR(aces(8.0 * std::exp2(e.start)), 0.85, 1e-6);
    EXPECT_NEAR(aces(0.25 * std::exp2(e.stop)), 0.85, 1e-6);
    EXPECT_NEAR(e.stop - e.start, 5.0, 1e-6);
    EXPECT_EQ(e.at(0), e.start);
    EXPECT_EQ(e.at(e.count - 1), e.stop);
}

TEST(HdrFlipExposures, AreAsManyAsStopsAndAtLeastTwo) {
    EXPECT_EQ(hdr_flip_exposures(two_lights(0.3f)).count, 5);  // 4.74 stops
    EXPECT_EQ(hdr_flip_exposures(two_lights(6.0f)).count, 2);
    EXPECT_EQ(hdr_flip_exposures(even_picture(3.0f)).count, 2);
}

TEST(HdrFlipExposures, FollowTheUnitOfRadiance) {
    const Exposures e = hdr_flip_exposures(two_lights()), brighter = hdr_flip_exposures(two_lights(1.0f, 32.0f));
    EXPECT_NEAR(brighter.start, e.start - 2.0, 1e-6);
    EXPECT_NEAR(brighter.stop, e.stop - 2.0, 1e-6);
    EXPECT_EQ(brighter.count, e.count);
}

TEST(HdrFlipExposures, BeforeBlackAreThoseOfTheLight) {
    const auto fire = [](float around) {
        return make_picture(48, 32, [around](int x, int) { return Rgb(x < 32 ? around : x < 44 ? 0.5f : 8.0f); });
    };
    const Exposures e = hdr_flip_exposures(fire(0.0f));
    EXPECT_NEAR(e.stop - e.start, 4.0, 1e-6);
    EXPECT_EQ(hdr_flip_exposures(fire(1e-9f)).stop, e.stop);  // rounding of a nothing is no light
    EXPECT_EQ(hdr_flip_exposures(even_picture(0.0f)).count, 2);
}

TEST(HdrFlip, OfEqualPicturesIsZero) {
    const HdrFlip flip = hdr_flip(two_lights(), two_lights());
    EXPECT_EQ(flip.mean, 0.0);
    EXPECT_EQ(*std::max_element(flip.errors.values.begin(), flip.errors.values.end()), 0.0f);
}

TEST(HdrFlip, DoesNotDependOnTheUnitOfRadiance) {
    const auto image = [](float unit) {
        return make_picture(48, 32,
                            [unit](int x, int y) { return unit * Rgb(x < 32 ? 0.25f : 8.0f - 0.1f * float(y)); });
    };
    const double mean = hdr_flip(image(1.0f), two_lights()).mean;
    EXPECT_GT(mean, 0.01);
    EXPECT_NEAR(hdr_flip(image(1024.0f), two_lights(256.0f, 8192.0f)).mean, mean, 1e-6);
}

// A spot in the dark is seen when that is exposed for, one in the light when the light is.
TEST(HdrFlip, FindsTheExposureThatShowsADifference) {
    const auto with_spot = [](int left, float value) {
        return make_picture(48, 32, [=](int x, int y) {
            const bool spot = x >= left && x < left + 8 && y >= 12 && y < 20;
            return Rgb(spot ? value : x < 32 ? 0.25f : 8.0f);
        });
    };
    const std::size_t dark = 16 * 48 + 12, bright = 16 * 48 + 40;
    const HdrFlip in_the_dark = hdr_flip(with_spot(8, 0.15f), two_lights());
    EXPECT_GE(in_the_dark.worst_exposures[dark], 2);  // from there on the dark is shown in middle tones
    EXPECT_GT(in_the_dark.errors.values[dark], 0.2f);
    const HdrFlip in_the_light = hdr_flip(with_spot(36, 5.0f), two_lights());
    EXPECT_EQ(in_the_light.worst_exposures[bright], 0);
    EXPECT_GT(in_the_light.errors.values[bright], 0.1f);
    EXPECT_LT(in_the_light.errors.values[dark], 1e-3f);
}

TEST(HdrFlip, SeesLightWhereThereShouldBeNone) {
    EXPECT_GT(hdr_flip(even_picture(1e-4f), even_picture(0.0f)).mean, 0.9);
    EXPECT_EQ(hdr_flip(even_picture(0.0f), even_picture(0.0f)).mean, 0.0);
}

TEST(HdrFlip, ShowsWhatIsNoRadianceAsBlackAndInfinityAsWhite) {
    const Picture reference = two_lights();
    for (const float value : {-5.0f, std::numeric_limits<float>::quiet_NaN()}) {
        Picture image = reference, black = reference;
        image.pixels[700] = Rgb(value);
        black.pixels[700] = Rgb(0.0f);
        EXPECT_EQ(hdr_flip(image, reference).errors.values, hdr_flip(black, reference).errors.values);
    }
    Picture image = reference, bright = reference;
    image.pixels[700] = Rgb(std::numeric_limits<float>::infinity());
    bright.pixels[700] = Rgb(1e30f);
    EXPECT_EQ(hdr_flip(image, reference).errors.values, hdr_flip(bright, reference).errors.values);
}

}  // namespace
}  // namespace brisance
