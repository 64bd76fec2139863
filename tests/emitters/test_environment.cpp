// Light from infinitely far.
#include <gtest/gtest.h>

#include <cmath>

#include "emitters/environment.h"
#include "fixtures/estimate.h"

namespace brisance {
namespace {

using namespace testing;

// A dim sky with a bright spot.
Texture sky(int width, int height) {
    Texture t;
    t.width = width;
    t.height = height;
    t.wrap_v = Wrap::Clamp;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool sun = std::abs(x - width / 4) < 2 && std::abs(y - height / 5) < 2;
            const float v = sun ? 500.0f : 0.2f + float(y) / float(height);
            t.floats.insert(t.floats.end(), {v, 0.7f * v, 0.5f * v, 1.0f});
        }
    return t;
}

LightSettings settings(char up, double degrees = 0.0) {
    LightSettings s;
    s.kind = LightKind::Environment;
    s.up = up;
    s.rotate_degrees = degrees;
    return s;
}

TEST(Environment, SamplesWithTheDensityItTells) {
    const Texture picture = sky(64, 32);
    for (const Texture* p : {&picture, static_cast<const Texture*>(nullptr)})
        for (const char up : {'y', 'z'}) {
            const Environment environment(settings(up, 33.0), p);
            // Mean of 1 / pdf is the sphere; of radiance / pdf the same integral as by even directions.
            const Estimate e = estimate_to(0.003, 2, [&](const dvec3& u, Rng&, double* out) {
                const dvec3 d = environment.sample(u.x, u.y);
                EXPECT_NEAR(glm::length(d), 1.0, 1e-9);
                out[0] = 1.0 / environment.pdf(d);
                out[1] = environment.radiance(d).x / environment.pdf(d);
            });
            const Estimate even = estimate_to(0.003, 1, [&](const dvec3& u, Rng&, double* out) {
                out[0] = 4.0 * kPi64 * environment.radiance(uniform_direction(u.x, u.y)).x;
            });
            EXPECT_NEAR(e.mean[0], 4.0 * kPi64, kSigmas * e.error[0] + 0.01);
            EXPECT_NEAR(e.mean[1], even.mean[0], kSigmas * std::hypot(e.error[1], even.error[0]));
        }
}

// A sun of one texel lights the texels around it by interpolation. What one sample of the irradiance brings is about 16
// times its mean at most, wherever it falls: a corner shared with the sun has a quarter of its radiance, and its texel
// is drawn by a 64th.
TEST(Environment, SamplesWhatInterpolationAddsBesideASun) {
    Texture picture;
    picture.width = 64;
    picture.height = 32;
    picture.floats.assign(64 * 32 * 4, 0.01f);
    for (int c = 0; c < 4; ++c)
        picture.floats[std::size_t((10 * 64 + 20) * 4 + c)] = 1e5f;
    const Environment environment(settings('z'), &picture);
    Rng rng(Stream::Points, 5);
    double mean = 0.0, largest = 0.0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
        const double u = rng.next_double();
        const dvec3 drawn = environment.sample(u, rng.next_double());
        mean += luminance(environment.radiance(drawn)) / environment.pdf(drawn) / kSamples;
        // Evenly over the texels around the sun: as BSDFs find them.
        const dvec3 beside =
            environment.direction_of((18.5 + 4.0 * rng.next_double()) / 64.0, (8.5 + 4.0 * rng.next_double()) / 32.0);
        largest = std::max(largest, luminance(environment.radiance(beside)) / environment.pdf(beside));
    }
    EXPECT_GT(mean, 1.0);
    EXPECT_LT(largest, 20.0 * mean);
}

// The picture's top is up, its middle looks along x, and x turns to the right side of the picture by -y (z up).
TEST(Environment, IsTheRightWayUpAndRound) {
    Texture t;
    t.width = 4;
    t.height = 2;
    t.nearest = true;
    t.wrap_v = Wrap::Clamp;
    // Top row: 1 2 3 4, bottom row: 5 6 7 8.
    for (int i = 1; i <= 8; ++i)
        t.floats.insert(t.floats.end(), {float(i), float(i), float(i), 1.0f});
    const auto seen = [&](const Environment& e, const dvec3& d) { return e.radiance(glm::normalize(d)).x; };
    const Environment z_up(settings('z'), &t);
    EXPECT_EQ(seen(z_up, {1.0, 0.1, 0.5}), 2.0f) << "left of the middle, which is +x";
    EXPECT_EQ(seen(z_up, {1.0, -0.1, 0.5}), 3.0f) << "right of the middle: -y";
    EXPECT_EQ(seen(z_up, {1.0, -0.1, -0.5}), 7.0f) << "below";
    EXPECT_EQ(seen(z_up, {-1.0, 0.1, 0.5}), 1.0f);
    const Environment y_up(settings('y'), &t);
    EXPECT_EQ(seen(y_up, {1.0, 0.5, 0.1}), 3.0f) << "right of the middle: +z";
    EXPECT_EQ(seen(y_up, {1.0, 0.5, -0.1}), 2.0f);
    const Environment turned(settings('z', 90.0), &t);
    EXPECT_EQ(seen(turned, {0.1, 1.0, 0.5}), 3.0f) << "its middle looks along y now";
}

}  // namespace
}  // namespace brisance
