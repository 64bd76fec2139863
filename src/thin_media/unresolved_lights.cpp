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

// Optical depths of what is seen at the distance of a level, at the eight corners of a brick.
using Corners = std::array<float, 8>;

Corners seen_depths(const Means& level, int up, const ivec3& brick, float length) {
    Corners out{};
    for (int k = 0; k < 8; ++k) {
        const auto [mean, square] = at_corner(level, up, brick + ivec3(k >> 2, k >> 1 & 1, k & 1));
        out[k] = mean > 0.0f ? length * std::cbrt(square * (square / mean)) : 0.0f;
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

}  // namespace

std::vector<float> depth_of_seen_lights(const Medium& medium) {
    const std::vector<Means> levels = mean_levels(medium);
    std::vector<float> depth(medium.extinction.size(), 0.0f);
    parallel_for(
        medium.lattice.brick_count(),
        [&](std::size_t b) {
            for (std::size_t l = 0; l < levels.size(); ++l) {
                const float distance = medium.spacing * float(1 << (kBrickLevel + int(l)));
                const Corners corners =
                    seen_depths(levels[l], int(l), medium.lattice.brick(b), distance * medium.max_extinction);
                for (int n = 0; n < BrickLattice::kNodes; ++n) {
                    const std::size_t i = b * BrickLattice::kNodes + n;
                    const vec3 part = vec3(BrickLattice::node_in_brick(n)) / float(BrickLattice::kSize);
                    const float seen =
                        std::min(between(corners, part), kOpaque) * std::exp(-medium.extinction[i] * distance);
                    depth[i] = std::max(depth[i], seen);
                }
            }
        },
        8);
    return depth;
}

std::vector<float> unresolved_lights(const Medium& medium) {
    std::vector<float> out = depth_of_seen_lights(medium);
    for (float& d : out)
        d = glm::smoothstep(kResolved, kUnresolved, d);
    return out;
}

}  // namespace brisance
