#include "pixel_sharing/noise_bands.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brisance {

namespace {

// Of blurs, in pixels. A gain's neighbourhood is that of three blurs, whose steps are two, four and eight times as
// wide.
constexpr int kBands[] = {1, 2, 4, 8, 16};
constexpr int kSides = 2;
constexpr float kSpline[] = {6.0f / 16.0f, 4.0f / 16.0f, 1.0f / 16.0f};

// Patches have nothing in common where their normals have a cosine below this, where they lie off each other's plane by
// this part of their distance and a pixel, or where the distances to surfaces around have this ratio. Those are told
// apart from so many pixels to so many.
constexpr float kNearest = 4.0f, kFarthest = 1e4f;
constexpr float kLeastFacing = 0.9f, kMostOffPlane = 0.05f, kMostRatio = 2.0f;

constexpr std::size_t kAtOnce = 4096;

float squared(float x) {
    return x * x;
}

// Squares of light, and of light with noise, over that of the light around: noise follows the light, and what is known
// of a highlight says nothing of what lies beside it.
struct Squares {
    float light = 0.0f, all = 0.0f;
};

// Wiener's. By chance noise seems to be light half of the time: what is below half of it is not taken for light, and
// what is far above is not touched.
float gain(const Squares& s) {
    constexpr float kChance = 0.5f;
    if (!(s.light > 0.0f))
        return 0.0f;
    const float chance = kChance * std::max(0.0f, s.all - s.light) / s.light;
    return std::min(1.0f, std::max(0.0f, 1.0f - squared(chance)) * s.light / s.all);
}

// Mean square of what a gain leaves of the noise and takes of the light.
float error_left(const Squares& s, float gain) {
    const float light = std::clamp(s.light, 0.0f, s.all);
    return squared(gain) * (s.all - light) + squared(1.0f - gain) * light;
}

class Bands {
public:
    explicit Bands(const PatchMap& map) : map_(map), distance_(map.patches.size(), 1.0f) { distance_ = distances(); }

    HalvedLight blurred(const HalvedLight& light, int step) const {
        HalvedLight out = light;
        map_.for_each([&](std::size_t pixel, std::uint32_t k) {
            MeanOfHalves mean(light);
            for_neighbours(pixel, k, step, [&](std::uint32_t j, float w) { mean.add(j, w * map_.patches[j].rays); });
            if (mean.any())
                mean.put(out, k);
        });
        return out;
    }

    // `kinds` of each patch.
    std::vector<Squares> blurred(const std::vector<Squares>& squares, std::size_t kinds, int step) const {
        std::vector<Squares> out = squares;
        map_.for_each([&](std::size_t pixel, std::uint32_t k) {
            std::array<Squares, MeanOfHalves::kMostKinds> sums{};
            float weights = 0.0f;
            for_neighbours(pixel, k, step, [&](std::uint32_t j, float w) {
                for (std::size_t kind = 0; kind < kinds; ++kind) {
                    sums[kind].light += w * squares[j * kinds + kind].light;
                    sums[kind].all += w * squares[j * kinds + kind].all;
                }
                weights += w;
            });
            for (std::size_t kind = 0; kind < kinds && weights > 0.0f; ++kind)
                out[k * kinds + kind] = {sums[kind].light / weights, sums[kind].all / weights};
        });
        return out;
    }

private:
    // To the surfaces around, from the closeness that samples found.
    std::vector<float> distances() const {
        std::vector<Squares> sums(map_.patches.size());
        for (std::size_t k = 0; k < sums.size(); ++k)
            sums[k] = {map_.patches[k].closeness, map_.patches[k].met};
        sums = blurred(blurred(sums, 1, 1), 1, 2);
        std::vector<float> out(sums.size());
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const float pixel = std::max(map_.patches[k].pixel_size, std::numeric_limits<float>::min());
            const float pixels = sums[k].all / (sums[k].light * pixel);
            out[k] = pixel * (pixels < kFarthest ? std::max(pixels, kNearest) : kFarthest);
        }
        return out;
    }

    template <class Take>
    void for_neighbours(std::size_t pixel, std::uint32_t number, int step, const Take& take) const {
        const Patch& patch = map_.patches[number];
        map_.for_around(pixel, kSides, step, [&](std::uint32_t k, int dx, int dy) {
            if (const float w = k == number ? 1.0f : in_common(patch, distance_[number], k); w > 0.0f)
                take(k, kSpline[std::abs(dx)] * kSpline[std::abs(dy)] * w);
        });
    }

    float in_common(const Patch& patch, float distance, std::uint32_t number) const {
        const Patch& other = map_.patches[number];
        const float facing = (glm::dot(other.normal, patch.normal) - kLeastFacing) / (1.0f - kLeastFacing);
        if (!(facing > 0.0f))
            return 0.0f;
        const vec3 offset = other.position - patch.position;
        const float off_plane =
            glm::dot(offset, patch.normal) / (kMostOffPlane * glm::length(offset) + patch.pixel_size);
        const float ratio = std::max(distance, distance_[number]) / std::min(distance, distance_[number]);
        const float apart = (ratio - 1.0f) / (kMostRatio - 1.0f);
        return facing * std::max(0.0f, 1.0f - squared(off_plane)) * alike(patch.lobe, other.lobe) *
               (apart < 1.0f ? squared(1.0f - squared(apart)) : 0.0f);
    }

    const PatchMap& map_;
    std::vector<float> distance_;
};

}  // namespace

CalmLight without_noise(const PatchMap& map, HalvedLight light) {
    const Bands bands(map);
    const std::size_t kinds = light.kinds, count = light.lights.size();
    CalmLight out{std::vector<Rgb>(count, Rgb(0.0f)), std::vector<float>(count, 0.0f)};
    std::vector<Squares> squares(count);
    std::vector<float> gains(count, 0.0f);
    for (const int step : kBands) {
        HalvedLight wide = bands.blurred(light, step);
        parallel_for(
            count,
            [&](std::size_t i) {
                const auto of_half = [&](std::size_t h) { return light.lights[i][h] - wide.lights[i][h]; };
                const Rgb around = wide.mean(i / kinds, i % kinds), all = light.mean(i / kinds, i % kinds) - around;
                const float scale = 1.0f / std::max(glm::dot(around, around), std::numeric_limits<float>::min());
                squares[i] = {scale * glm::dot(of_half(0), of_half(1)), scale * glm::dot(all, all)};
            },
            kAtOnce);
        for (const int wider : {2, 4, 8})
            squares = bands.blurred(squares, kinds, wider * step);
        parallel_for(
            count,
            [&](std::size_t i) {
                const float known = std::max(gains[i], gain(squares[i]));
                const Rgb around = wide.mean(i / kinds, i % kinds);
                out.lights[i] += (known - gains[i]) * light.mean(i / kinds, i % kinds);
                out.square_errors[i] += glm::dot(around, around) * error_left(squares[i], known);
                gains[i] = known;
            },
            kAtOnce);
        light = std::move(wide);
    }
    for (std::size_t i = 0; i < count; ++i)
        out.lights[i] += (1.0f - gains[i]) * light.mean(i / kinds, i % kinds);
    return out;
}

}  // namespace brisance
