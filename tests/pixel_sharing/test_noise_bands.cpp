// Noise on surfaces is told from light: it vanishes where samples say that it is noise, and what they know stays.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/rng.h"
#include "pixel_sharing/noise_bands.h"

namespace brisance {
namespace {

constexpr int kColumns = 96, kRows = 64, kSamples = 8;

using Light = std::function<float(int x, int y)>;
using Noise = std::function<float(float light, Rng& rng)>;  // a sample's light

// A wall that faces the camera, a pixel wide 1 m, with equal halves of samples.
struct Wall {
    PatchMap map{kColumns, kRows};
    HalvedLight light;
    std::vector<float> truth, noisy;  // of each pixel
};

Wall calm_wall(const Light& light, const Noise& noise, std::uint64_t seed = 1) {
    Wall out;
    Rng rng(Stream::Surface, seed);
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < kColumns; ++x) {
            const float here = light(x, y);
            HalvedLight::Halves halves{Rgb(0.0f), Rgb(0.0f)};
            for (int k = 0; k < kSamples; ++k)
                halves[k % 2] += Rgb(noise(here, rng) / float(kSamples / 2));
            out.map.first[out.map.patches.size()] = static_cast<std::uint32_t>(out.map.patches.size());
            Patch p;
            p.position = vec3(float(x), float(y), 0.0f);
            p.normal = vec3(0.0f, 0.0f, 1.0f);
            p.pixel_size = p.area = p.lobe = 1.0f;
            p.weight = Rgb(1.0f);
            p.closeness = 0.02f;
            p.met = 1.0f;
            p.samples = p.rays = float(kSamples);
            out.map.patches.push_back(p);
            out.light.lights.push_back(halves);
            out.light.first.push_back(0.5f);
            out.truth.push_back(here);
            out.noisy.push_back(0.5f * (halves[0].x + halves[1].x));
        }
    return out;
}

double square_error(const Wall& w, const std::function<float(std::size_t)>& of) {
    double sum = 0.0;
    for (std::size_t p = 0; p < w.truth.size(); ++p)
        sum += std::pow(double(of(p)) - double(w.truth[p]), 2.0);
    return sum;
}

double square_error(const Wall& w, const CalmLight& calm) {
    return square_error(w, [&](std::size_t p) { return calm.lights[p].x; });
}

double square_error_of_noise(const Wall& w) {
    return square_error(w, [&](std::size_t p) { return w.noisy[p]; });
}

float smooth(int x, int y) {
    return 1.0f + 0.5f * std::sin(0.05f * float(x)) * std::cos(0.06f * float(y));
}

// Rare and bright, of mean `light`, with ten times its standard deviation.
float grains(float light, Rng& rng) {
    return rng.next() < 0.01f ? 100.0f * light : 0.0f;
}

float even_noise(float light, Rng& rng) {
    return light * 2.0f * rng.next();
}

TEST(NoiseBands, TakeNoiseFromSmoothLight) {
    for (const Noise& noise : {Noise(even_noise), Noise(grains)}) {
        const Wall w = calm_wall(smooth, noise);
        const double before = square_error_of_noise(w), after = square_error(w, without_noise(w.map, w.light));
        std::printf("variance over %.0f\n", before / after);
        EXPECT_GT(before, 40.0 * after);
    }
}

// An edge that geometry does not show, such as that of a shadow: samples with little noise know it.
TEST(NoiseBands, KeepWhatSamplesKnow) {
    const auto edge = [](int x, int) { return x < kColumns / 2 ? 0.1f : 1.0f; };
    const auto little = [](float light, Rng& rng) { return light * (0.9f + 0.2f * rng.next()); };
    const Wall w = calm_wall(edge, little);
    const CalmLight calm = without_noise(w.map, w.light);
    EXPECT_LT(square_error(w, calm), square_error_of_noise(w));
    for (std::size_t p = 0; p < w.truth.size(); ++p)
        EXPECT_NEAR(calm.lights[p].x, w.truth[p], 0.1f * w.truth[p]) << p;
}

// With as much noise as light, the same edge may blur, but no pixel gets worse than its samples on the whole.
TEST(NoiseBands, GainWhereEdgesDrownInNoise) {
    const Wall w = calm_wall([](int x, int) { return x < kColumns / 2 ? 0.1f : 1.0f; }, grains);
    EXPECT_LT(square_error(w, without_noise(w.map, w.light)), 0.1 * square_error_of_noise(w));
}

// The expected error is the error within a factor of two, from a few per cent of noise in a sample to ten times its
// light.
TEST(NoiseBands, KnowTheirError) {
    const auto waves = [](int x, int y) { return 1.0f + 0.8f * std::sin(0.5f * float(x)) * std::cos(0.4f * float(y)); };
    const auto little = [](float light, Rng& rng) { return light * (0.95f + 0.1f * rng.next()); };
    for (const Noise& noise : {Noise(little), Noise(even_noise), Noise(grains)}) {
        const Wall w = calm_wall(waves, noise);
        const CalmLight calm = without_noise(w.map, w.light);
        double expected = 0.0;
        for (const float e : calm.square_errors)
            expected += double(e) / 3.0;  // three equal channels
        const double ratio = std::sqrt(expected / square_error(w, calm));
        std::printf("expected over actual error %.2f\n", ratio);
        EXPECT_GT(ratio, 0.5);
        EXPECT_LT(ratio, 2.0);
    }
}

// Light is never negative, whatever bright grains lie beside it.
TEST(NoiseBands, LeaveNoNegativeLight) {
    const Wall w = calm_wall([](int x, int) { return x % 16 == 0 ? 10.0f : 0.01f; }, grains);
    for (const Rgb& light : without_noise(w.map, w.light).lights)
        ASSERT_GE(light.x, 0.0f);
}

// Kinds of light have gains of their own: noise in one does not blur the other.
TEST(NoiseBands, KeepKindsApart) {
    const auto edge = [](int x, int) { return x < kColumns / 2 ? 0.1f : 1.0f; };
    const Wall known = calm_wall(edge, [](float light, Rng&) { return light; }), noisy = calm_wall(smooth, grains);
    HalvedLight both{2, {}, known.light.first};
    for (std::size_t p = 0; p < known.light.lights.size(); ++p) {
        both.lights.push_back(known.light.lights[p]);
        both.lights.push_back(noisy.light.lights[p]);
    }
    const CalmLight alone = without_noise(known.map, known.light), together = without_noise(known.map, both);
    for (std::size_t p = 0; p < alone.lights.size(); ++p)
        ASSERT_EQ(together.lights[2 * p], alone.lights[p]);
}

}  // namespace
}  // namespace brisance
