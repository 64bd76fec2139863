// Edges of emitters: the error of the part of a pixel that a lamp covers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "camera/pixel_samples.h"
#include "camera_rays/picture.h"
#include "fixtures/sets.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kWidth = 12, kHeight = 10;
constexpr double kDistance = 4.0;

CameraSettings camera_settings() {
    CameraSettings s;
    s.eye = {0.0, 0.0, kDistance};
    s.target = {0.0, 0.0, 0.0};
    s.up = {0.0, 1.0, 0.0};
    s.vertical_fov_degrees = 20.0;
    s.width = kWidth;
    s.height = kHeight;
    return s;
}

// A lamp that fills a rectangle of the picture, in pixels from its lower left corner, before black.
struct Rectangle {
    double left, right, low, high;
};

std::vector<float> picture(const Rectangle& r, int samples, int refinement) {
    const Medium medium;
    const Camera camera(camera_settings(), medium);
    const double pixel = camera.pixel_angle() * kDistance;
    Scene scene;
    const dvec3 corner((r.left - 0.5 * kWidth) * pixel, (r.low - 0.5 * kHeight) * pixel, 0.0);
    add_quad(scene, vec3(corner), {float((r.right - r.left) * pixel), 0, 0}, {0, float((r.high - r.low) * pixel), 0},
             emitting(Rgb(1.0f)));
    const Surroundings surroundings(std::move(scene), {});
    PictureSettings settings;
    settings.samples_per_axis = samples;
    settings.edge_refinement = refinement;
    settings.layers = {Cell::A};
    settings.surroundings = &surroundings;
    Progress silent;
    const Image image = render_picture(SourceField(medium), camera, settings, silent);
    std::vector<float> out;
    const std::vector<float>& a = image.layer("A").pixels;
    for (std::size_t i = 0; i < a.size(); i += 3)
        out.push_back(a[i]);
    return out;
}

double filled(const Rectangle& r, int x, int y) {
    const double low = kHeight - 1 - y;  // rows go down
    const double width = std::min(r.right, x + 1.0) - std::max(r.left, double(x));
    const double height = std::min(r.high, low + 1.0) - std::max(r.low, low);
    return std::max(width, 0.0) * std::max(height, 0.0);
}

double largest_error(const Rectangle& r, const std::vector<float>& picture) {
    double worst = 0.0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            worst = std::max(worst, std::abs(picture[y * kWidth + x] - filled(r, x, y)));
    return worst;
}

// Level and upright edges: each is wrong by half a sample's row at most, of all rows of all samples.
TEST(Edges, PixelsKnowWhatPartOfThemALampFills) {
    const Rectangle lamp{2.37, 8.71, 3.18, 6.44};
    EXPECT_LT(largest_error(lamp, picture(lamp, 4, 1)), 2.0 / 16.0);
    EXPECT_GT(largest_error(lamp, picture(lamp, 4, 1)), 0.01);
    EXPECT_LT(largest_error(lamp, picture(lamp, 4, 4)), 2.0 / 256.0);
    EXPECT_LT(largest_error(lamp, picture(lamp, 1, 16)), 2.0 / 256.0);
}

// It lies in the gaps between the rays of most pixels. Rays of neighbouring pixels that hit it find it.
TEST(Edges, AStripThinnerThanTheGapsBetweenRaysIsWhole) {
    const Rectangle strip{2.37, 8.71, 4.45, 4.56};
    const std::vector<float> own = picture(strip, 3, 1), refined = picture(strip, 3, 8);
    EXPECT_GT(largest_error(strip, own), 0.03);
    EXPECT_LT(largest_error(strip, refined), 0.01);
}

TEST(Edges, WhatIsEvenIsNotLookedAtAgain) {
    const Rectangle all{-5.0, kWidth + 5.0, -5.0, kHeight + 5.0};
    EXPECT_EQ(picture(all, 2, 1), picture(all, 2, 4));
}

}  // namespace
}  // namespace brisance
