#include "thin_media/unresolved_lights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "medium/lattice/extinction_pyramid.h"
#include "thin_media/brick_points.h"

namespace brisance {

namespace {

// Optical depths of seen lights below which their maps are right to some percent, and above which they are not.
constexpr float kResolved = 2.5f, kUnresolved = 7.5f;
// Beyond this depth smoke is opaque, and no worse represented for being denser: it does not make its surroundings thin.
constexpr float kOpaque = 100.0f;
// Of the extinction that is seen, that nearby below which a node lies in haze, and above which it does not; and how
// many times depth counts in haze.
constexpr float kHaze = 0.05f, kNoHaze = 0.2f, kInHaze = 5.0f;
// Optical depth of what is seen at which the smoke's own lights bring 1 / e of its light, as measured.
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

// `fine`: the levels below kBrickLevel that tell of what is nearby; `coarse`: those from there on.
constexpr int kNearer = 2;  // nearby is a quarter of the distance, in levels
struct Levels {
    std::array<Means, kNearer> fine;
    std::vector<Means> coarse;
};

Levels mean_levels(const Medium& medium) {
    Means means{medium.lattice, std::vector<float>(2 * medium.extinction.size())};
    // Relative to the largest, so that no square overflows.
    const float scale = medium.max_extinction > 0.0f ? 1.0f / medium.max_extinction : 0.0f;
    for (std::size_t i = 0; i < medium.extinction.size(); ++i) {
        const float e = scale * medium.extinction[i];
        means.values[2 * i] = e;
        means.values[2 * i + 1] = e * e;
    }
    Levels levels;
    static_assert(kBrickLevel == kNearer + 1);
    levels.fine[0] = coarser(means);
    levels.fine[1] = coarser(levels.fine[0]);
    levels.coarse.push_back(coarser(levels.fine[1]));
    const ivec3 extent = medium.lattice.brick_extent();
    const int bricks = std::max({extent.x, extent.y, extent.z});
    for (int wide = 1; wide < bricks; wide *= 2)
        levels.coarse.push_back(coarser(levels.coarse.back()));
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

// Extinctions that light meets nearby, and where it is seen.
float times_in_haze(float near, float far) {
    return glm::mix(kInHaze, 1.0f, glm::smoothstep(kHaze * far, kNoHaze * far, near));
}

// Values at the corners, in the order of Corners.
using BrickCorners = BrickPoints<1>;

template <int kIntervals>
using Around = std::array<float, BrickPoints<kIntervals>::kCount>;

// The extinction that light meets at points of a brick, by the level whose nodes they are.

template <int kIntervals>
Around<kIntervals> extinction_around(const Means& level, const ivec3& brick) {
    using Points = BrickPoints<kIntervals>;
    std::array<float, 2 * Points::kCount> box;
    copy_box(level.lattice, level.values, 2, brick * kIntervals, ivec3(Points::kSide), box);
    Around<kIntervals> out;
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = box[i] > 0.0f ? box[out.size() + i] / box[i] : 0.0f;
    return out;
}

// What the nodes of a brick see at each distance. `f`: called with a node, the depth, and how many times that counts.
template <class F>
void see_from_brick(const Medium& medium, const Levels& levels, std::size_t b, const F& f) {
    const ivec3 brick = medium.lattice.brick(b);
    std::vector<SeenAtCorners> corners(levels.coarse.size());
    const Around<4> nearest = extinction_around<4>(levels.fine[0], brick);
    const Around<2> next = extinction_around<2>(levels.fine[1], brick);
    const auto nearby = [&](std::size_t l, int n) {
        return l == 0   ? BrickPoints<4>::at(nearest.data(), n)
               : l == 1 ? BrickPoints<2>::at(next.data(), n)
                        : BrickCorners::at(corners[l - kNearer].extinction.data(), n);
    };
    for (std::size_t l = 0; l < corners.size(); ++l) {
        const float distance = medium.spacing * float(1 << (kBrickLevel + int(l)));
        corners[l] = seen_at_corners(levels.coarse[l], int(l), brick, distance * medium.max_extinction);
        if (!(std::ranges::max(corners[l].depth) > 0.0f))
            continue;
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const std::size_t i = b * BrickLattice::kNodes + std::size_t(n);
            const float through = std::exp(-medium.extinction[i] * distance);
            const float seen = std::min(BrickCorners::at(corners[l].depth.data(), n), kOpaque) * through;
            const bool may_count = kInHaze * seen > kResolved && seen < kUnresolved;  // else it makes no difference
            const float times =
                may_count ? times_in_haze(nearby(l, n), BrickCorners::at(corners[l].extinction.data(), n)) : 1.0f;
            f(i, seen, times);
        }
    }
}

}  // namespace

std::vector<float> depth_of_seen_lights(const Medium& medium) {
    const Levels levels = mean_levels(medium);
    std::vector<float> depth(medium.extinction.size(), 0.0f);
    parallel_for(
        medium.lattice.brick_count(),
        [&](std::size_t b) {
            see_from_brick(medium, levels, b,
                           [&](std::size_t i, float seen, float) { depth[i] = std::max(depth[i], seen); });
        },
        8);
    return depth;
}

UnresolvedLights unresolved_lights(const Medium& medium) {
    const Levels levels = mean_levels(medium);
    UnresolvedLights out{std::vector<float>(medium.extinction.size()), std::vector<float>(medium.extinction.size())};
    parallel_for(
        medium.lattice.brick_count(),
        [&](std::size_t b) {
            see_from_brick(medium, levels, b, [&](std::size_t i, float seen, float times) {
                const float weight = glm::smoothstep(kResolved, kUnresolved, times * seen);
                out.weight[i] = std::max(out.weight[i], weight);
                out.lost[i] = std::max(out.lost[i], weight * (1.0f - std::exp(-seen / kLost)));
            });
        },
        8);
    return out;
}

}  // namespace brisance
