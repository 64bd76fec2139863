// Samples shaded in rounds: which are, how often, and for how many they stand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/rng.h"
#include "surface_lighting/surface_rounds.h"

namespace brisance {
namespace {

constexpr int kAcross = 12, kDown = 8, kFirstRow = 3;
constexpr std::size_t kRaysOfPixel = 16;
constexpr float kTolerance = 0.02f;

using Light = std::function<float(int x, int y, int ray)>;

struct Band {
    std::vector<SurfaceSample> samples;
    std::vector<float> even, sampled;

    // `kept`: whether a ray met a surface.
    explicit Band(const Light& light, const std::function<bool(int, int, int)>& kept = {}, float beside = 0.0f) {
        for (int y = 0; y < kDown; ++y)
            for (int x = 0; x < kAcross; ++x)
                for (int k = 0; k < int(kRaysOfPixel); ++k) {
                    if (kept && !kept(x, y, k))
                        continue;
                    SurfaceSample s{};
                    s.pixel = std::uint32_t((y + kFirstRow) * kAcross + x);
                    s.number = std::uint64_t(k);
                    s.share = 1.0f / float(kRaysOfPixel);
                    s.beside = beside;
                    samples.push_back(s);
                    even.push_back(0.0f);
                    sampled.push_back(light(x, y, k));
                }
    }
    SurfaceRounds::Found found(float shared = 0.0f) const {
        return {sampled, std::vector<float>(samples.size(), shared)};
    }
    SurfaceRounds rounds(float part = kTolerance, float typical = 1.0f,
                         SurfaceRounds::ToldBy told_by = SurfaceRounds::ToldBy::Others) const {
        return {samples, kAcross, kRaysOfPixel, {part, typical}, told_by};
    }
    std::size_t at(int x, int y, int ray) const { return (std::size_t(y) * kAcross + x) * kRaysOfPixel + ray; }
};

bool is_first(const SurfaceRounds& rounds, std::size_t sample) {
    return std::ranges::find(rounds.first(), sample) != rounds.first().end();
}

TEST(SurfaceRounds, EvenLightWantsAQuarterOfTheRaysAndKeepsItsEnergy) {
    const Band band([](int, int, int) { return 0.7f; });
    SurfaceRounds rounds = band.rounds();
    EXPECT_EQ(rounds.first().size(), band.samples.size() / 4);
    EXPECT_TRUE(rounds.second(band.even, band.found()).empty());
    std::vector<float> pixels(kAcross * kDown, 0.0f);
    for (std::size_t i = 0; i < band.samples.size(); ++i) {
        EXPECT_EQ(rounds.stands_for(i) > 0.0f, is_first(rounds, i));
        pixels[i / kRaysOfPixel] += rounds.stands_for(i) * band.samples[i].share * band.sampled[i];
    }
    for (const float p : pixels)
        EXPECT_NEAR(p, 0.7f, 1e-5f);
}

// The few lie in different rows and columns of the pixel: a ramp across it, either way, is nearly known by them.
TEST(SurfaceRounds, TheFewAreSpreadOverThePixel) {
    for (const bool across : {true, false}) {
        const Band band([&](int, int, int k) { return across ? float(k % 4) : float(k / 4); });
        SurfaceRounds rounds = band.rounds(1e6f);
        ASSERT_TRUE(rounds.second(band.even, band.found()).empty());
        float sum = 0.0f;
        for (std::size_t k = 0; k < kRaysOfPixel; ++k)
            sum += rounds.stands_for(k) * band.samples[k].share * band.sampled[k];
        EXPECT_NEAR(sum, 1.5f, 1e-5f);
    }
}

// One pixel's few differ. Those around, which may have missed what makes it so, get all their rays, and it does not:
// its own samples have no say in how many it gets.
TEST(SurfaceRounds, ErrorAsksForAllRaysAround) {
    constexpr int kX = 5, kY = 4;
    const Band band([](int x, int y, int k) { return x == kX && y == kY && k == 2 ? 5.0f : 1.0f; });
    SurfaceRounds rounds = band.rounds();
    ASSERT_TRUE(is_first(rounds, band.at(kX, kY, 2)));
    const std::vector<std::size_t> second = rounds.second(band.even, band.found());
    EXPECT_EQ(second.size(), 24 * kRaysOfPixel * 3 / 4);
    for (const std::size_t i : second)
        EXPECT_FALSE(is_first(rounds, i));
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
            const int apart = std::max(std::abs(x - kX), std::abs(y - kY));
            for (int k = 0; k < int(kRaysOfPixel); ++k) {
                const float stands = rounds.stands_for(band.at(x, y, k));
                const bool all = stands == 1.0f, few = stands == 0.0f || std::abs(stands - 4.0f) < 1e-5f;
                EXPECT_TRUE(apart == 1 || apart == 2 ? all : few) << x << " " << y << " " << k << ": " << stands;
            }
        }
}

// Where light has edges as narrow as pixels and no grains, its own few tell of it, too.
TEST(SurfaceRounds, OwnSamplesMayTellToo) {
    const Band band([](int x, int y, int k) { return x == 5 && y == 4 && k == 2 ? 5.0f : 1.0f; });
    SurfaceRounds rounds = band.rounds(kTolerance, 1.0f, SurfaceRounds::ToldBy::OwnToo);
    EXPECT_EQ(rounds.second(band.even, band.found()).size(), 9 * kRaysOfPixel * 3 / 4);
    EXPECT_EQ(rounds.stands_for(band.at(5, 4, 2)), 1.0f);
}

// How much luminance pixels of independent noise hold after all rounds, in parts of what they should: noise(random
// number) of each sample and pass.
double mean_of_all_rounds(const std::function<float(float)>& noise, int bands) {
    double sum = 0.0;
    for (int n = 0; n < bands; ++n) {
        const auto light = [&](int x, int y, int ray, int pass) {
            return noise(Rng(Stream::Surface, std::uint64_t(x + 100 * y) << 32 | std::uint64_t(n),
                             std::uint64_t(ray + 100 * pass))
                             .next());
        };
        const Band band([&](int x, int y, int k) { return light(x, y, k, 0); });
        SurfaceRounds rounds = band.rounds(0.2f);
        rounds.second(band.even, band.found());
        const std::vector<SurfaceRounds::Again> again = rounds.further(band.even, band.found());
        for (std::size_t i = 0; i < band.samples.size(); ++i)
            sum += double(rounds.stands_for(i) * band.samples[i].share * band.sampled[i]);
        for (const SurfaceRounds::Again& a : again) {
            const int pixel = int(a.sample / kRaysOfPixel);
            sum += double(rounds.stands_for(a.sample) * band.samples[a.sample].share *
                          light(pixel % kAcross, pixel / kAcross, int(a.sample % kRaysOfPixel), int(a.pass)));
        }
    }
    return sum / (bands * kAcross * kDown);
}

// Light of samples of which one in a hundred is a hundred times as bright as the mean: pixels that found one must not
// divide it by more samples than those that found none. With four samples of each pixel in 400 bands the mean has a
// standard error of 2.5 %, and with what is shaded besides less: within two of those.
TEST(SurfaceRounds, RareBrightSamplesKeepTheirLight) {
    const double mean = mean_of_all_rounds([](float u) { return u < 0.01f ? 100.0f : 0.0f; }, 400);
    EXPECT_NEAR(mean, 1.0, 0.05);
}

// What a pixel may err by falls with the root of its luminance: of two halves of a picture with the same relative
// noise, the one of the typical luminance wants all rays, and so does a brighter one; one of a hundredth is content.
TEST(SurfaceRounds, DarkPixelsMayErrByMoreOfThemselves) {
    for (const float luminance : {4.0f, 1.0f, 0.01f}) {
        const Band band([&](int x, int y, int k) {
            return luminance *
                   (1.0f + 0.4f * Rng(Stream::Surface, std::uint64_t(x + 100 * y), std::uint64_t(k)).next());
        });
        SurfaceRounds rounds = band.rounds();
        const std::size_t second = rounds.second(band.even, band.found()).size();
        EXPECT_EQ(second, luminance < 1.0f ? 0 : band.samples.size() * 3 / 4) << luminance;
        // Without a typical luminance they are alike.
        SurfaceRounds alone = band.rounds(kTolerance, 0.0f);
        EXPECT_EQ(alone.second(band.even, band.found()).size(), band.samples.size() * 3 / 4) << luminance;
    }
}

// As many samples as the noise wants: its variance over the tolerated one decides between a quarter of the rays, half
// of them, all, and passes of all. All of a pixel's samples stand for as much, and together for the pixel.
TEST(SurfaceRounds, NoiseDecidesHowManySamples) {
    // Half of the samples are brighter by a step, and half darker: the mean of four has a variance of step^2 / 3, as
    // these four tell.
    const auto samples_for = [](float step) {
        const Band band([&](int, int, int k) { return 1.0f + (k % 2 == 0 ? step : -step); });
        SurfaceRounds rounds = band.rounds();
        rounds.second(band.even, band.found());
        const auto again = rounds.further(band.even, band.found());
        double samples = double(again.size()), stand_for = 0.0;
        for (const SurfaceRounds::Again& a : again)
            stand_for += double(rounds.stands_for(a.sample));
        for (std::size_t i = 0; i < band.samples.size(); ++i) {
            samples += rounds.stands_for(i) > 0.0f ? 1.0 : 0.0;
            stand_for += double(rounds.stands_for(i));
        }
        EXPECT_NEAR(stand_for, double(band.samples.size()), 1e-3) << step;
        return samples / (kAcross * kDown);
    };
    const auto step_of = [](double samples) { return float(std::sqrt(0.75 * samples) * kTolerance); };
    EXPECT_EQ(samples_for(0.0f), 4.0);
    EXPECT_EQ(samples_for(step_of(3.9)), 4.0);
    EXPECT_EQ(samples_for(step_of(7.0)), 8.0);
    EXPECT_EQ(samples_for(step_of(12.0)), 16.0);
    EXPECT_EQ(samples_for(step_of(1e6)), 64.0);
    double before = 16.0;
    for (const double wanted : {24.0, 40.0, 56.0}) {
        const double samples = samples_for(step_of(wanted));
        EXPECT_GE(samples, before);
        EXPECT_EQ(std::fmod(samples, 16.0), 0.0);
        EXPECT_NEAR(samples, wanted, 16.0);
        before = samples;
    }
}

// Noise of light that makes little of the pixel wants no more rays.
TEST(SurfaceRounds, TheErrorIsThatOfThePixel) {
    const auto noisy = [](int x, int y, int k) { return Rng(Stream::Surface, x + 100 * y, k).next(); };
    const Band alone(noisy), beside_bright(noisy, {}, 1e4f);
    SurfaceRounds rounds = alone.rounds(), others = beside_bright.rounds();
    EXPECT_EQ(rounds.second(alone.even, alone.found()).size(), alone.samples.size() * 3 / 4);
    EXPECT_TRUE(others.second(beside_bright.even, beside_bright.found()).empty());
    SurfaceRounds with_shared = alone.rounds();
    EXPECT_TRUE(with_shared.second(alone.even, alone.found(1e4f)).empty());
}

TEST(SurfaceRounds, EdgesAndNoToleranceHaveAllRaysAtOnce) {
    const Light even = [](int, int, int) { return 1.0f; };
    const Band whole(even), cut(even, [](int x, int, int k) { return x != 3 || k < 9; });
    EXPECT_EQ(whole.rounds(0.0f).first().size(), whole.samples.size());
    SurfaceRounds rounds = cut.rounds();
    EXPECT_EQ(rounds.first().size(), std::size_t(kDown) * ((kAcross - 1) * kRaysOfPixel / 4 + 9));
    EXPECT_TRUE(rounds.second(cut.even, cut.found()).empty());
    for (std::size_t i = 0; i < cut.samples.size(); ++i)
        if (cut.samples[i].pixel % kAcross == 3) {
            EXPECT_EQ(rounds.stands_for(i), 1.0f);
        }
}

// Light of the medium is a little noisy. Alone it wants all its rays; not beside reflections that stay noisier than
// that with all of theirs; beside steady ones it does.
TEST(SurfaceRounds, LightBesideNoiseNeedNotBeBetterKnown) {
    const auto noise_of = [](float height) {
        return [height](int x, int y, int k) { return 1.0f + height * Rng(Stream::Surface, x + 100 * y, k).next(); };
    };
    const Band little(noise_of(0.3f)), much(noise_of(3.0f)), none([](int, int, int) { return 1.0f; });
    const std::size_t all_others = little.samples.size() * 3 / 4;
    EXPECT_EQ(little.rounds().second(little.even, little.found()).size(), all_others);
    SurfaceRounds noisy = much.rounds(), beside_noisy = little.rounds();
    EXPECT_EQ(noisy.second(much.even, much.found()).size(), all_others);
    EXPECT_TRUE(beside_noisy.second(little.even, little.found(), &noisy).empty());
    SurfaceRounds steady = none.rounds(), beside_steady = little.rounds();
    EXPECT_TRUE(steady.second(none.even, none.found()).empty());
    EXPECT_EQ(beside_steady.second(little.even, little.found(), &steady).size(), all_others);
}

TEST(SurfaceRounds, AreNoneWithoutSamples) {
    SurfaceRounds rounds({}, kAcross, kRaysOfPixel, {kTolerance, 1.0f}, SurfaceRounds::ToldBy::Others);
    EXPECT_TRUE(rounds.first().empty());
    EXPECT_TRUE(rounds.second({}, {}).empty());
    EXPECT_TRUE(rounds.further({}, {}).empty());
}

}  // namespace
}  // namespace brisance
