// View transforms: from radiance to a displayed colour.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "film/view_transform.h"
#include "film/write_image.h"
#include "fixtures.h"

namespace brisance {
namespace {

using testing::gray_image;
using testing::make_layer;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(View, BlackIsBlackAndInfinityIsWhite) {
    for (const ViewTransform view : {ViewTransform::Filmic, ViewTransform::Srgb}) {
        EXPECT_EQ(apply_view(Rgb(0.0f), view), vec3(0.0f));
        EXPECT_EQ(apply_view(Rgb(-1.0f), view), vec3(0.0f));
        EXPECT_EQ(apply_view(Rgb(std::nanf("")), view), vec3(0.0f));
        EXPECT_LT(glm::length(apply_view(Rgb(kInfinity), view) - vec3(1.0f)), 1e-4f);
    }
}

TEST(View, GrayStaysGrayAndRises) {
    for (const ViewTransform view : {ViewTransform::Filmic, ViewTransform::Srgb}) {
        float before = 0.0f;
        for (float stops = -10.0f; stops <= 10.0f; stops += 0.25f) {
            const vec3 shown = apply_view(Rgb(std::exp2(stops)), view);
            EXPECT_NEAR(shown.x, shown.z, 1e-6f);
            EXPECT_NEAR(shown.x, shown.y, 1e-6f);
            EXPECT_GE(shown.x, before);
            before = shown.x;
        }
    }
}

// 1500 K: red is 200 times blue. Clipping turns it into flat yellow; film lets it run to white.
TEST(View, BrightFireRunsToWhiteUnderFilmic) {
    const Rgb fire(1.0f, 0.25f, 0.005f);
    const vec3 clipped = apply_view(64.0f * fire, ViewTransform::Srgb);
    EXPECT_NEAR(clipped.y, 1.0f, 1e-6f);
    EXPECT_LT(clipped.z, 0.65f);
    const vec3 film = apply_view(64.0f * fire, ViewTransform::Filmic);
    EXPECT_GT(film.z, 0.9f);
    float before = 0.0f;
    for (float stops = -3.0f; stops <= 8.0f; stops += 0.25f) {
        const vec3 shown = apply_view(std::exp2(stops) * fire, ViewTransform::Filmic);
        EXPECT_GT(shown.x, shown.y);  // stays fire on the way: red over green over blue
        EXPECT_GT(shown.y, shown.z);
        EXPECT_GT(shown.z / shown.x, before);  // ever closer to white
        before = shown.z / shown.x;
    }
}

TEST(View, DimFireKeepsItsColourUnderFilmic) {
    const vec3 shown = apply_view(0.18f * Rgb(1.0f, 0.25f, 0.005f), ViewTransform::Filmic);
    EXPECT_LT(shown.z, 0.1f * shown.x);
}

TEST(AutomaticExposure, BringsAnEvenPictureJustBelowWhite) {
    EXPECT_NEAR(automatic_exposure(gray_image(16, 16, 0.45f)), 1.0f, 1e-5f);
    EXPECT_NEAR(automatic_exposure(gray_image(16, 16, 3.6f)), -2.0f, 1e-5f);
}

TEST(AutomaticExposure, DoesNotDependOnTheBlackAround) {
    const auto small = [](int x, int y, int c) {
        return x < 10 && y < 10 ? 0.1f * static_cast<float>(1 + x + c) : 0.0f;
    };
    const Image tight{10, 10, {make_layer("", {"R", "G", "B", "A"}, 10, 10, small)}};
    const Image wide{200, 100, {make_layer("", {"R", "G", "B", "A"}, 200, 100, small)}};
    EXPECT_EQ(automatic_exposure(tight), automatic_exposure(wide));
}

TEST(AutomaticExposure, ScalesWithThePicture) {
    const auto value = [](int x, int y, int) { return 0.01f * static_cast<float>(1 + x * y); };
    Image image{40, 40, {make_layer("", {"R", "G", "B"}, 40, 40, value)}};
    const float before = automatic_exposure(image);
    for (float& v : image.layers[0].pixels)
        v *= 1024.0f;
    EXPECT_NEAR(automatic_exposure(image), before - 10.0f, 1e-5f);
}

TEST(AutomaticExposure, IsZeroWithoutLightAndUnmovedByInfinities) {
    EXPECT_EQ(automatic_exposure(gray_image(4, 4, 0.0f)), 0.0f);
    EXPECT_EQ(automatic_exposure(gray_image(4, 4, kInfinity)), 0.0f);
    Image image = gray_image(4, 4, 0.45f);
    image.layers[0].pixels[0] = kInfinity;
    EXPECT_NEAR(automatic_exposure(image), 1.0f, 1e-5f);
}

}  // namespace
}  // namespace brisance
