#include "scattering/lattice_level.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr float kError = 0.023f, kErrorBeforeFineBounce = 0.016f;
// Of the error of the picture, what a series may add.
constexpr float kShare = 0.625f, kNearlyAllowed = 1.2f;
// On voxels two levels wider than the light's own a series takes a tenth of the frame's time: wider ones save little.
constexpr float kWidest = 2.0f;
// What the rim of smoke adds, over the width of a voxel in radii. On voxels a quarter of the radius wide a white ball
// of two mean free paths erred by 3.3 % instead of 1.5 on half of that, and a ball of albedo 0.8 with a wall through it
// lost 5 % of MM.
constexpr float kErrorOfRim = 0.1f;
// Where more is allowed, other errors grow, too, and wider voxels save nothing: drafts of the built-in explosion erred
// by 3.4 instead of 2.7 % in the same time.
constexpr float kUsual = 0.02f;
// The errors at which fine bounces begin, and at which they are whole. Below, finer lattices err less: a fine bounce
// darkens a real fireball by 0.9 %.
constexpr float kErrorOfNoBounce = 0.01f, kErrorOfBounce = 0.02f;

// Of the light of a series on coarser lattices, the part that fine bounces replace.
float weight_of_fine_bounces(const ScatteringSettings& settings, float error) {
    if (settings.fine_bounces >= 0)
        return settings.fine_bounces > 0 ? 1.0f : 0.0f;
    return std::clamp((error - kErrorOfNoBounce) / (kErrorOfBounce - kErrorOfNoBounce), 0.0f, 1.0f);
}

// `weight` of a node.
template <class Weight>
SmokeMet met(const Medium& medium, const Weight& weight) {
    const std::size_t bricks = medium.lattice.brick_count();
    std::vector<dvec3> sums(bricks, dvec3(0.0));              // of weights, extinction and albedo
    std::vector<glm::dvec2> filled(bricks, glm::dvec2(0.0));  // of the extinction and its square
    parallel_for(
        bricks,
        [&](std::size_t b) {
            for (std::size_t i = b * BrickLattice::kNodes; i < (b + 1) * BrickLattice::kNodes; ++i) {
                const double extinction = medium.extinction[i];
                filled[b] += glm::dvec2(extinction, extinction * extinction);
                if (const double w = weight(i); w > 0.0)
                    sums[b] += w * dvec3(1.0, extinction, luminance(medium.albedo_at(i)));
            }
        },
        16);
    dvec3 all(0.0);
    glm::dvec2 smoke(0.0);
    for (std::size_t b = 0; b < bricks; ++b) {
        all += sums[b];
        smoke += filled[b];
    }
    SmokeMet out{0.0f, 0.0f, medium.mean_cosine, 0.0f};
    if (smoke.y > 0.0)
        out.radius = static_cast<float>(std::cbrt(3.0 / (4.0 * double(kPi)) * smoke.x * smoke.x / smoke.y));
    if (all.x > 0.0) {
        out.depth = static_cast<float>(medium.spacing * all.y / all.x);
        out.albedo = static_cast<float>(all.z / all.x);
    }
    return out;
}

}  // namespace

SmokeMet SmokeMet::coarser(int level) const {
    return {std::ldexp(depth, level), albedo, mean_cosine, std::ldexp(radius, -level)};
}

SmokeMet smoke_met(const Medium& medium, std::span<const Rgb> scattered) {
    return met(medium, [&](std::size_t i) { return double(luminance(scattered[i])); });
}

SmokeMet smoke_met(const Medium& medium) {
    return met(medium, [&](std::size_t i) { return double(medium.extinction[i]); });
}

float error_of_series(const SmokeMet& smoke, const ScatteringSettings& settings, float error, int level) {
    const float a = smoke.albedo, depth = (1.0f - smoke.mean_cosine) * std::ldexp(smoke.depth, level);
    return std::lerp(kError, kErrorBeforeFineBounce * a, weight_of_fine_bounces(settings, error)) * a * a * depth;
}

LatticeChoice lattice_of_series(const SmokeMet& smoke, const ScatteringSettings& settings, float error, int last) {
    if (settings.lattice_level >= 0)
        return {std::min(settings.lattice_level, last), 0.0f};
    const float allowed = kShare * std::min(error, kUsual);
    if (!(allowed > 0.0f))
        return {};
    float level = 0.0f;
    for (float next = 0.0f; level < kWidest && next <= 1.0f;) {
        next = error_of_series(smoke, settings, error, static_cast<int>(level) + 1) / allowed;
        level += 1.0f - glm::smoothstep(1.0f, kNearlyAllowed, next);
    }
    const float widest = allowed / kErrorOfRim * smoke.radius;
    level = std::clamp(std::log2(widest), 0.0f, std::min(level, float(last)));
    return {static_cast<int>(level), level - std::floor(level)};
}

float share_of_fine_bounces(const LatticeChoice& lattice, const ScatteringSettings& settings, float error) {
    return weight_of_fine_bounces(settings, error) * (lattice.level > 0 ? 1.0f : lattice.share_of_coarser);
}

}  // namespace brisance
