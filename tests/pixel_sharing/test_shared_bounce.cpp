// Pixels that share light between surfaces: constants and energy are kept, edges are not crossed, noise falls.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/rng.h"
#include "pixel_sharing/shared_bounce.h"

namespace brisance {
namespace {

constexpr int kWidth = 96, kHeight = 64, kRays = 4;
constexpr float kPixel = 0.01f;  // [m]

using Sample = SharedBounce::Sample;

using Finish = std::function<void(Sample&, Rng&)>;

// The samples of a wall that faces the camera, `rays` in each pixel. `finish` sets the light, and what else differs.
void for_samples_of_wall(const Finish& finish, int rays, const std::function<void(const Sample&)>& take) {
    Rng rng(Stream::Surface, 1);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int k = 0; k < rays; ++k) {
                Sample s;
                s.pixel = std::uint32_t(y * kWidth + x);
                s.position = vec3(float(x) + rng.next(), float(y) + rng.next(), 0.0f) * kPixel;
                s.normal = vec3(0.0f, 0.0f, 1.0f);
                s.pixel_size = kPixel;
                s.area = kPixel * kPixel;
                s.weight = Rgb(1.0f / float(rays));
                s.closeness = 0.5f;
                finish(s, rng);
                take(s);
            }
}

SharedBounce wall(double radius, const Finish& finish, int rays = kRays, std::vector<SharedBounce::Apart> told = {}) {
    SharedBounce shared(kWidth, kHeight, radius, rays, std::move(told));
    for_samples_of_wall(finish, rays, [&](const Sample& s) { shared.add(s); });
    return shared;
}

// What pixels show by themselves.
std::vector<Rgb> unshared(const Finish& finish, int rays = kRays) {
    std::vector<Rgb> pixels(std::size_t(kWidth) * kHeight, Rgb(0.0f));
    for_samples_of_wall(finish, rays, [&](const Sample& s) { pixels[s.pixel] += s.weight * s.light; });
    return pixels;
}

struct Spread {
    double mean = 0.0, variance = 0.0;
};

Spread spread(const std::vector<Rgb>& pixels) {
    Spread s;
    for (const Rgb& p : pixels)
        s.mean += p.y / double(pixels.size());
    for (const Rgb& p : pixels)
        s.variance += (p.y - s.mean) * (p.y - s.mean) / double(pixels.size());
    return s;
}

// Rare and bright, as grains are.
void grain(Sample& s, Rng& rng) {
    s.light = Rgb(rng.next() < 0.02f ? 50.0f : 0.0f);
}

// Bright pixels have eight samples and dark ones one. Samples that stand for an eighth of a ray count for as much: what
// pixels share is the same as if all had one, and no light is added to the dark.
TEST(SharedBounce, MoreSamplesOfAPixelCountForNoMore) {
    const auto pixels = [](int of_bright) {
        SharedBounce shared(kWidth, kHeight, 0.2, 1);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const bool bright = x >= kWidth / 2;
                const int samples = bright ? of_bright : 1;
                Sample s;
                s.pixel = std::uint32_t(y * kWidth + x);
                s.position = vec3(float(x), float(y), 0.0f) * kPixel;
                s.normal = vec3(0.0f, 0.0f, 1.0f);
                s.pixel_size = kPixel;
                s.area = kPixel * kPixel;
                s.light = Rgb(bright ? 3.0f : 1.0f);
                s.rays = 1.0f / float(samples);
                s.weight = Rgb(s.rays);
                s.closeness = 2.0f;
                for (int k = 0; k < samples; ++k)
                    shared.add(s);
            }
        return shared.take_pixels();
    };
    const std::vector<Rgb> alike = pixels(1), more = pixels(8);
    EXPECT_NEAR(spread(more).mean, spread(alike).mean, 1e-4);
    for (std::size_t i = 0; i < alike.size(); ++i)
        ASSERT_NEAR(more[i].y, alike[i].y, 0.02f) << i;
}

TEST(SharedBounce, KeepsConstantLightOnAnyColour) {
    float colour = 0.0f;
    SharedBounce shared = wall(0.2, [&](Sample& s, Rng& rng) {
        colour = 0.1f + 0.8f * rng.next();
        s.light = Rgb(1.0f, 2.0f, 3.0f);
        s.weight *= colour;
    });
    Rgb mean(0.0f);
    const std::vector<Rgb> pixels = shared.take_pixels();
    for (const Rgb& p : pixels) {
        EXPECT_NEAR(p.y / p.x, 2.0f, 1e-4f);
        EXPECT_NEAR(p.z / p.x, 3.0f, 1e-4f);
        mean += p / float(pixels.size());
    }
    EXPECT_NEAR(mean.x, 0.5f, 0.01f);  // of the colours: 0.23 / sqrt(4 * 96 * 64) = 0.0015
}

// A quarter of the light of every pixel stays a quarter, and is nothing new to the whole.
TEST(SharedBounce, TellsAPartApart) {
    for (const double radius : {0.0, 0.2}) {
        const auto divide = [](Sample& s, Rng& rng) {
            grain(s, rng);
            s.of(SharedBounce::Apart::Residual) = 0.25f * s.light;
        };
        SharedBounce whole = wall(radius, grain),
                     divided = wall(radius, divide, kRays, {SharedBounce::Apart::Residual});
        const std::vector<Rgb> all = divided.take_pixels(), part = divided.told_pixels(SharedBounce::Apart::Residual);
        EXPECT_EQ(all, whole.take_pixels());
        for (std::size_t p = 0; p < all.size(); ++p)
            ASSERT_EQ(part[p], 0.25f * all[p]);
    }
}

// The mean of grains has a standard error of 4.5 % here, the variance of single pixels is divided by the number of
// pixels that share: more than fifty.
TEST(SharedBounce, DividesNoiseAndKeepsEnergy) {
    const Spread alone = spread(unshared(grain)), shared = spread(wall(0.2, grain).take_pixels());
    EXPECT_LT(shared.variance, alone.variance / 50.0);
    EXPECT_NEAR(shared.mean, alone.mean, 0.03 * alone.mean);  // pixels at the border share with fewer
    EXPECT_NEAR(shared.mean, 1.0, 3.0 * 0.045);
}

// Noise is divided by at least as many pixels as it says beforehand, within a half. What noise is left is told from
// light besides.
TEST(SharedBounce, SaysHowManyPixelsShare) {
    const Spread alone = spread(unshared(grain));
    for (const float closeness : {0.5f, 2.0f, 4.0f}) {
        Sample one;
        SharedBounce shared = wall(0.2, [&](Sample& s, Rng& rng) {
            grain(s, rng);
            s.closeness = closeness;
            one = s;
        });
        const float said = shared.pixels_sharing(one, closeness);
        const double is = alone.variance / spread(shared.take_pixels()).variance;
        std::printf("closeness %g: %.0f pixels, said %.0f\n", closeness, is, said);
        EXPECT_LT(said, is * 1.5);
    }
}

TEST(SharedBounce, CrossesNoEdgeOfNormals) {
    SharedBounce shared = wall(0.2, [](Sample& s, Rng&) {
        const bool right = s.pixel % kWidth >= kWidth / 2;
        s.light = Rgb(right ? 1.0f : 0.0f);
        s.normal = right ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 0.0f, 1.0f);
    });
    const std::vector<Rgb> pixels = shared.take_pixels();
    for (std::size_t p = 0; p < pixels.size(); ++p)
        EXPECT_NEAR(pixels[p].x, p % kWidth >= kWidth / 2 ? 1.0f : 0.0f, 1e-5f) << p;
}

// A step in depth of ten pixels, within the radius, between walls that face the same way; half of the pixels see both.
TEST(SharedBounce, CrossesNoStepInDepth) {
    SharedBounce shared = wall(0.2, [](Sample& s, Rng& rng) {
        const bool behind = rng.next() < 0.5f;
        s.light = Rgb(behind ? 1.0f : 0.0f);
        s.position.z = behind ? -10.0f * kPixel : 0.0f;
        s.weight = behind ? Rgb(1.0f, 0.0f, 0.0f) : Rgb(0.0f, 1.0f, 0.0f);
    });
    for (const Rgb& p : shared.take_pixels()) {
        EXPECT_NEAR(p.x, std::round(p.x), 1e-4f);  // a whole number of samples, each of light 1
        EXPECT_EQ(p.y, 0.0f);
    }
}

// Light varies over a part of the distance to what sends it: beside a surface two pixels away it is not blurred.
TEST(SharedBounce, StaysSharpBesideOtherSurfaces) {
    SharedBounce shared = wall(0.2, [](Sample& s, Rng&) {
        s.light = Rgb(s.pixel % kWidth >= kWidth / 2 ? 1.0f : 0.0f);
        s.closeness = 1.0f / (2.0f * kPixel);
    });
    const std::vector<Rgb> pixels = shared.take_pixels();
    for (std::size_t p = 0; p < pixels.size(); ++p)
        if (const int from_edge = std::abs(int(p % kWidth) - kWidth / 2); from_edge > 3) {
            EXPECT_NEAR(pixels[p].x, p % kWidth >= kWidth / 2 ? 1.0f : 0.0f, 1e-5f) << p;
        }
}

// A camera that lies in the wall has pixels without size.
TEST(SharedBounce, LeavesWhatTheCameraTouchesAsItIs) {
    SharedBounce shared = wall(0.2, [](Sample& s, Rng& rng) {
        s.light = Rgb(rng.next());
        s.pixel_size = 0.0f;
        s.position = vec3(0.0f);
    });
    for (const Rgb& p : shared.take_pixels())
        EXPECT_TRUE(p.x > 0.0f && p.x < 1.0f);
}

// Base and lobes of other widths at the same place have other light, and share none of it.
TEST(SharedBounce, KeepsLobesApart) {
    SharedBounce shared = wall(0.2, [](Sample& s, Rng& rng) {
        const int kind = int(rng.next() * 3.0f);
        s.lobe = kind == 0 ? 1.0f : kind == 1 ? 0.7f : 0.3f;
        s.light = s.weight = Rgb(0.0f);
        s.light[kind] = s.weight[kind] = 1.0f;
    });
    for (const Rgb& p : shared.take_pixels()) {
        EXPECT_NEAR(p.x + p.y + p.z, float(kRays), 1e-4f);
        EXPECT_NEAR(p.x, std::round(p.x), 1e-4f);
        EXPECT_NEAR(p.y, std::round(p.y), 1e-4f);
    }
}

// A lobe sees a part of the surroundings: with its width the blur of an edge of light falls to nothing.
TEST(SharedBounce, BlursLessOnGlossierSurfaces) {
    const auto blurred = [](float lobe) {
        int count = 0;
        SharedBounce shared = wall(0.2, [&](Sample& s, Rng&) {
            s.light = Rgb(s.pixel % kWidth >= kWidth / 2 ? 1.0f : 0.0f);
            s.lobe = lobe;
        });
        for (const Rgb& p : shared.take_pixels())
            count += p.x > 0.01f && p.x < 0.99f;
        return count;
    };
    EXPECT_LT(blurred(0.2f), 0.6 * blurred(0.6f));
    EXPECT_EQ(blurred(0.01f), 0);
}

// What finds no place in a crowded pixel is left to the caller.
TEST(SharedBounce, RefusesPixelsOfManySurfaces) {
    SharedBounce shared(1, 1, 0.2, 16);
    int taken = 0;
    for (int k = 0; k < 16; ++k) {
        Sample s;
        s.position = vec3(0.0f, 0.0f, float(k));
        s.normal = vec3(0.0f, 0.0f, 1.0f);
        s.pixel_size = kPixel;
        s.area = kPixel * kPixel;
        s.light = s.weight = Rgb(1.0f);
        taken += shared.add(s);
    }
    EXPECT_GE(taken, 1);
    EXPECT_LT(taken, 16);
    EXPECT_NEAR(shared.take_pixels()[0].x, float(taken), 1e-5f);
}

// A floor toward the horizon: pixels show more of it, and more pixels lie on what is far. Light that falls evenly from
// near to far stays what it is, away from the ends.
TEST(SharedBounce, KeepsAGradientInPerspective) {
    SharedBounce shared(kWidth, kHeight, 0.2, 1);
    const auto distance = [](int y) { return 1.0f / (0.1f + 0.01f * float(y)); };  // [m], 10 to 1.4
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            Sample s;
            s.pixel = std::uint32_t(y * kWidth + x);
            const float z = distance(y);
            s.position = vec3(0.01f * float(x) * z, z, 0.0f);
            s.normal = vec3(0.0f, 0.0f, 1.0f);
            s.pixel_size = 0.01f * z;
            s.area = 0.01f * z * (distance(y) - distance(y + 1));
            s.light = Rgb(z);
            s.weight = Rgb(1.0f);
            s.closeness = 1.0f / 3.0f;
            shared.add(s);
        }
    const std::vector<Rgb> pixels = shared.take_pixels();
    for (int y = 12; y < 29; ++y)
        EXPECT_NEAR(pixels[std::size_t(y) * kWidth + kWidth / 2].x, distance(y), 0.02f * distance(y)) << y;
}

// Half of the wall is bright by a surface two pixels away, half is dark with nothing near: the dark half reaches far,
// but the bright one does not give.
TEST(SharedBounce, GivesNoFartherThanItsOwnLightIsSmooth) {
    SharedBounce shared = wall(0.2, [](Sample& s, Rng&) {
        const bool bright = s.pixel % kWidth >= kWidth / 2;
        s.light = Rgb(bright ? 1.0f : 0.0f);
        s.closeness = bright ? 1.0f / (2.0f * kPixel) : 0.5f;
    });
    const std::vector<Rgb> pixels = shared.take_pixels();
    for (std::size_t p = 0; p < pixels.size(); ++p)
        if (p % kWidth < kWidth / 2 - 8) {
            EXPECT_LT(pixels[p].x, 0.02f) << p;
        }
}

// Consistent: with more rays of a pixel the blur of an edge of light gets narrower.
TEST(SharedBounce, BlursLessWithMoreRays) {
    const auto edge = [](Sample& s, Rng&) { s.light = Rgb(s.pixel % kWidth >= kWidth / 2 ? 1.0f : 0.0f); };
    const auto blurred = [&](int rays) {
        int count = 0;
        for (const Rgb& p : wall(0.05, edge, rays).take_pixels())
            count += p.x > 0.01f && p.x < 0.99f;
        return count;
    };
    EXPECT_LT(blurred(64), 0.8 * blurred(1));
}

}  // namespace
}  // namespace brisance
