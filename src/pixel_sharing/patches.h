// The surfaces that pixels show, and the light on them of two halves of the samples.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/vec.h"

namespace brisance {

// The samples of a pixel that lie on one surface, of lobes of one width: sums, then their means, but for `weight`.
struct Patch {
    static constexpr std::uint32_t kNone = ~0u;
    vec3 position{0.0f}, normal{0.0f};
    float pixel_size = 0.0f, area = 0.0f, lobe = 0.0f;
    Rgb weight{0.0f};                    // the pixel shows the light times this
    float closeness = 0.0f, met = 0.0f;  // and how many samples met a surface
    float samples = 0.0f;
    float rays = 0.0f;  // of the pixel, that the samples stand for: where many are taken, light must not count for more
    std::uint32_t next = kNone;  // of the pixel
};

struct PatchMap {
    static constexpr std::uint32_t kNone = Patch::kNone;
    int width, height;
    std::vector<std::uint32_t> first;  // patch of each pixel
    std::vector<Patch> patches;

    PatchMap(int columns, int rows) : width(columns), height(rows), first(std::size_t(columns) * rows, kNone) {}

    template <class Visit>
    void for_each(const Visit& visit) const {  // visit(pixel, patch), in parallel
        parallel_for(
            first.size(),
            [&](std::size_t pixel) {
                for (std::uint32_t k = first[pixel]; k != kNone; k = patches[k].next)
                    visit(pixel, k);
            },
            256);
    }

    // visit(patch, dx, dy) for those of pixels that lie dx and dy steps from one, up to `reach` to each side.
    template <class Visit>
    void for_around(std::size_t pixel, int reach, int step, const Visit& visit) const {
        const int x = int(pixel % std::size_t(width)), y = int(pixel / std::size_t(width));
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) {
                const int u = x + dx * step, v = y + dy * step;
                if (u < 0 || u >= width || v < 0 || v >= height)
                    continue;
                for (std::uint32_t k = first[std::size_t(v) * width + u]; k != kNone; k = patches[k].next)
                    visit(k, dx, dy);
            }
    }
};

// 1 for lobes of the same width, 0 for others.
inline float alike(float lobe, float other) {
    constexpr float kOtherLobe = 0.2f;  // by which part widths differ that share nothing
    const float apart = (lobe - other) / (kOtherLobe * std::max(lobe, other));
    return std::max(0.0f, 1.0f - apart * apart);
}

// Lights of several kinds on patches, each known twice: the samples of a pixel belong to two halves in turn, whose
// noise is independent. The mean of both is that of all samples: halves count as their samples do.
struct HalvedLight {
    using Halves = std::array<Rgb, 2>;
    std::size_t kinds = 1;
    std::vector<Halves> lights;  // `kinds` of each patch
    std::vector<float> first;    // the part of its samples that belong to the first half, of each patch

    Rgb mean(std::size_t patch, std::size_t kind) const {
        const Halves& h = lights[patch * kinds + kind];
        return first[patch] * h[0] + (1.0f - first[patch]) * h[1];
    }
};

// A weighted mean of lights on patches.
class MeanOfHalves {
public:
    static constexpr std::size_t kMostKinds = 5;

    explicit MeanOfHalves(const HalvedLight& of) : of_(of) {}

    void add(std::size_t patch, float weight) {
        const std::array<float, 2> w = {weight * of_.first[patch], weight * (1.0f - of_.first[patch])};
        for (std::size_t kind = 0; kind < of_.kinds; ++kind)
            for (std::size_t h = 0; h < 2; ++h)
                sums_[kind][h] += w[h] * of_.lights[patch * of_.kinds + kind][h];
        weights_[0] += w[0];
        weights_[1] += w[1];
    }
    bool any() const { return weights_[0] + weights_[1] > 0.0f; }

    // A half without samples takes the other's light: then nothing is told to be noise.
    void put(HalvedLight& out, std::size_t patch) const {
        for (std::size_t kind = 0; kind < of_.kinds; ++kind)
            for (std::size_t h = 0; h < 2; ++h) {
                const std::size_t from = weights_[h] > 0.0f ? h : 1 - h;
                out.lights[patch * of_.kinds + kind][h] = sums_[kind][from] / weights_[from];
            }
        out.first[patch] = weights_[0] / (weights_[0] + weights_[1]);
    }

private:
    const HalvedLight& of_;
    std::array<HalvedLight::Halves, kMostKinds> sums_{};
    std::array<float, 2> weights_{};
};

}  // namespace brisance
