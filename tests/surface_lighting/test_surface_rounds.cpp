// Samples shaded in two rounds: which are, and for how many they stand.
#include <gtest/gtest.h>

#include <algorithm>
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
    SurfaceRounds rounds(float tolerance = kTolerance) const { return {samples, kAcross, kRaysOfPixel, tolerance}; }
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

// One pixel's few differ. It, and those beside, whose own few may have missed what makes it so, get all their rays.
TEST(SurfaceRounds, ErrorAsksForAllRaysThereAndBeside) {
    constexpr int kX = 5, kY = 4;
    const Band band([](int x, int y, int k) { return x == kX && y == kY && k == 2 ? 5.0f : 1.0f; });
    SurfaceRounds rounds = band.rounds();
    ASSERT_TRUE(is_first(rounds, band.at(kX, kY, 2)));
    const std::vector<std::size_t> second = rounds.second(band.even, band.found());
    EXPECT_EQ(second.size(), 9 * kRaysOfPixel * 3 / 4);
    for (const std::size_t i : second)
        EXPECT_FALSE(is_first(rounds, i));
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
            const bool near = std::abs(x - kX) <= 1 && std::abs(y - kY) <= 1;
            for (int k = 0; k < int(kRaysOfPixel); ++k) {
                const float stands = rounds.stands_for(band.at(x, y, k));
                const bool kept = stands == 1.0f, split = stands == 0.0f || std::abs(stands - 4.0f) < 1e-5f;
                EXPECT_TRUE(near ? kept : split) << x << " " << y << " " << k << ": " << stands;
            }
        }
}

// Noise of light that makes little of the pixel wants no more rays.
TEST(SurfaceRounds, TheErrorIsThatOfThePixel) {
    const auto noisy = [](int x, int y, int k) { return Rng(Stream::Surface, x + 100 * y, k).next(); };
    const Band alone(noisy), beside_bright(noisy, {}, 100.0f);
    SurfaceRounds rounds = alone.rounds(), others = beside_bright.rounds();
    EXPECT_EQ(rounds.second(alone.even, alone.found()).size(), alone.samples.size() * 3 / 4);
    EXPECT_TRUE(others.second(beside_bright.even, beside_bright.found()).empty());
    SurfaceRounds with_shared = alone.rounds();
    EXPECT_TRUE(with_shared.second(alone.even, alone.found(100.0f)).empty());
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
    SurfaceRounds rounds({}, kAcross, kRaysOfPixel, kTolerance);
    EXPECT_TRUE(rounds.first().empty());
    EXPECT_TRUE(rounds.second({}, {}).empty());
}

}  // namespace
}  // namespace brisance
