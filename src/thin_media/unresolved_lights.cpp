#include "thin_media/unresolved_lights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "medium/lattice/extinction_pyramid.h"

namespace brisance {

namespace {

// Optical depths of seen lights below which their maps are right to some percent, and above which they are not.
constexpr float kResolved = 2.5f, kUnresolved = 7.5f;
// Beyond this depth smoke is opaque, and no worse represented for being denser: it does not make its surroundings thin.
constexpr float kOpaque = 100.0f;
// Of the extinction that is seen, that nearby below which a node lies in haze, and above which it does not; and how
// many times depth counts in haze.
constexpr float kHaze = 0.05f, kNoHaze = 0.2f, kInHaze = 5.0f;
// Nearby is a quarter of the distance, in levels, but no nearer than the finest.
constexpr std::size_t kNearer = 2;
// Optical depth at which what is seen sends 1 / e of its light by its own lights, as measured.
constexpr float kLost = 5.0f;

// Means of the extinction and of its square on ever coarser lattices. Nodes of the level kBrickLevel are the corners of
// the medium's bricks.
struct Means {
    BrickLattice lattice;
    std::vector<float> values;  // interleaved
};
constexpr int kBrickLevel = 3;

Means coarser(const Means& fine) {
    Means coarse;
    coarsen(fine.lattice, fine.values, 2, coarse.lattice, coarse.values);
    return coarse;
}

// The levels from kBrickLevel on.
std::vector<Means> mean_levels(const Medium& medium) {
    Means means{medium.lattice, std::vector<float>(2 * medium.extinction.size())};
    // Relative to the largest, so that no square overflows.
    const float scale = medium.max_extinction > 0.0f ? 1.0f / medium.max_extinction : 0.0f;
    for (std::size_t i = 0; i < medium.extinction.size(); ++i) {
        const float e = scale * medium.extinction[i];
        means.values[2 * i] = e;
        means.values[2 * i + 1] = e * e;
    }
    for (int l = 0; l < kBrickLevel; ++l)
        means = coarser(means);
    const ivec3 extent = medium.lattice.brick_extent();
    const int bricks = std::max({extent.x, extent.y, extent.z});
    std::vector<Means> levels;
    levels.push_back(std::move(means));
    for (int wide = 1; wide < bricks; wide *= 2)
        levels.push_back(coarser(levels.back()));
    return levels;
}

// Both means at a corner of bricks, in a level `up` above kBrickLevel.
std::array<float, 2> at_corner(const Means& level, int up, const ivec3& corner) {
    const ivec3 low = corner >> up;
    const vec3 part = vec3(corner - (low << up)) / float(1 << up);
    std::array<float, 2> sum{};
    for (int k = 0; k < 8; ++k) {
        const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
        const vec3 w = glm::mix(1.0f - part, part, vec3(d));
        const std::int64_t i = level.lattice.find_node(low + d);
        for (int c = 0; c < 2 && i >= 0; ++c)
            sum[c] += w.x * w.y * w.z * level.values[2 * i + c];
    }
    return sum;
}

// What is seen at the distance of a level, at the eight corners of a brick.
using Corners = std::array<float, 8>;
struct SeenAtCorners {
    Corners depth{};       // optical
    Corners extinction{};  // that light meets there, over the medium's largest
};

SeenAtCorners seen_at_corners(const Means& level, int up, const ivec3& brick, float length) {
    SeenAtCorners out;
    for (int k = 0; k < 8; ++k) {
        const auto [mean, square] = at_corner(level, up, brick + ivec3(k >> 2, k >> 1 & 1, k & 1));
        if (!(mean > 0.0f))
            continue;
        out.depth[k] = length * std::cbrt(square * (square / mean));
        out.extinction[k] = square / mean;
    }
    return out;
}

float between(const Corners& corners, const vec3& part) {
    float sum = 0.0f;
    for (int k = 0; k < 8; ++k) {
        const vec3 w = glm::mix(1.0f - part, part, vec3(k >> 2, k >> 1 & 1, k & 1));
        sum += w.x * w.y * w.z * corners[k];
    }
    return sum;
}

// Extinctions that light meets nearby, and where it is seen.
float times_in_haze(float near, float far) {
    return glm::mix(kInHaze, 1.0f, glm::smoothstep(kHaze * far, kNoHaze * far, near));
}

}  // namespace

namespace {

// Per node: D, and D as it counts.
struct Depths {
    std::vector<float> seen, counted;
};

Depths depths_of(const Medium& medium) {
    const std::vector<Means> levels = mean_levels(medium);
    Depths depths{std::vector<float>(medium.extinction.size()), std::vector<float>(medium.extinction.size())};
    parallel_for(
        medium.lattice.brick_count(),
        [&](std::size_t b) {
            std::vector<SeenAtCorners> corners;
            for (std::size_t l = 0; l < levels.size(); ++l) {
                const float distance = medium.spacing * float(1 << (kBrickLevel + int(l)));
                corners.push_back(
                    seen_at_corners(levels[l], int(l), medium.lattice.brick(b), distance * medium.max_extinction));
                for (int n = 0; n < BrickLattice::kNodes; ++n) {
                    const std::size_t i = b * BrickLattice::kNodes + n;
                    const vec3 part = vec3(BrickLattice::node_in_brick(n)) / float(BrickLattice::kSize);
                    const float own = medium.extinction[i],
                                seen = std::min(between(corners[l].depth, part), kOpaque) * std::exp(-own * distance);
                    depths.seen[i] = std::max(depths.seen[i], seen);
                    const std::size_t near = l > kNearer ? l - kNearer : 0;
                    const float times =
                        times_in_haze(between(corners[near].extinction, part), between(corners[l].extinction, part));
                    depths.counted[i] = std::max(depths.counted[i], times * seen);
                }
            }
        },
        8);
    return depths;
}

}  // namespace

std::vector<float> depth_of_seen_lights(const Medium& medium) {
    return depths_of(medium).seen;
}

UnresolvedLights unresolved_lights(const Medium& medium) {
    Depths depths = depths_of(medium);
    UnresolvedLights out{std::move(depths.counted), std::move(depths.seen)};
    for (std::size_t i = 0; i < out.weight.size(); ++i) {
        out.weight[i] = glm::smoothstep(kResolved, kUnresolved, out.weight[i]);
        out.lost[i] = out.weight[i] * (1.0f - std::exp(-out.lost[i] / kLost));
    }
    return out;
}

}  // namespace brisance
