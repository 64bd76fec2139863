// Implementation of voxel_walk.h: two nested digital differential analysers, over bricks and over cubes.
#pragma once

#include <algorithm>
#include <cmath>

namespace brisance::detail {

// Amanatides and Woo, A Fast Voxel Traversal Algorithm for Ray Tracing, Eurographics 1987; cubes of `size` nodes.
class Walker {
public:
    Walker(const dvec3& origin, const dvec3& direction, double begin, double size, const ivec3& low, const ivec3& high)
        : origin_(origin), direction_(direction), size_(size) {
        for (int a = 0; a < 3; ++a) {
            const double p = (origin[a] + direction[a] * begin) / size;
            cube[a] = std::clamp(static_cast<int>(std::floor(p)), low[a], high[a]);
            // Exactly on a face the cube ahead is the one the ray is about to enter.
            if (direction[a] < 0.0 && p == std::floor(p) && cube[a] > low[a] && p == cube[a])
                --cube[a];
            per_node_[a] = direction[a] == 0.0 ? 0.0 : 1.0 / direction[a];
            crossing_[a] = next_crossing(a);
        }
    }

    ivec3 cube{0};

    double exit() const { return std::min({crossing_.x, crossing_.y, crossing_.z}); }

    void advance() {
        // Which axis it is cannot be foretold: chosen so that compilers need no branch.
        const int x_or_y = crossing_.x <= crossing_.y ? 0 : 1;
        const int a = std::min(crossing_.x, crossing_.y) <= crossing_.z ? x_or_y : 2;
        cube[a] += direction_[a] > 0.0 ? 1 : -1;
        crossing_[a] = next_crossing(a);
    }

private:
    double next_crossing(int a) const {
        if (direction_[a] == 0.0)
            return std::numeric_limits<double>::infinity();
        return ((cube[a] + (direction_[a] > 0.0 ? 1 : 0)) * size_ - origin_[a]) * per_node_[a];
    }

    dvec3 origin_, direction_, per_node_{0.0}, crossing_{0.0};
    double size_;
};

inline bool inside(const ivec3& cube, const ivec3& count) {
    return std::min({cube.x, cube.y, cube.z}) >= 0 && cube.x < count.x && cube.y < count.y && cube.z < count.z;
}

}  // namespace brisance::detail

namespace brisance {

template <class Visit>
bool walk_bricks(const BrickLattice& bricks, const LatticeRay& ray, const Visit& visit) {
    constexpr int kSize = BrickLattice::kSize;
    if (ray.empty())
        return true;
    const ivec3 low = bricks.min_brick(), count = bricks.brick_extent();
    double begin = ray.begin;
    detail::Walker walker(ray.origin, ray.direction, begin, kSize, ivec3(0), count - 1);
    while (begin < ray.end) {
        const ivec3 b = walker.cube;
        const double leave = std::min(walker.exit(), ray.end);
        const int brick = bricks.find(low + b);
        if (brick >= 0 && leave > begin &&
            !visit(VoxelSegment{std::size_t(brick), begin, leave, ray.origin - dvec3(b * kSize), ray.direction}))
            return false;
        begin = std::max(begin, leave);
        walker.advance();
        if (!detail::inside(walker.cube, count))
            break;
    }
    return true;
}

template <int size, class Visit>
bool walk_cubes(const VoxelSegment& s, const Visit& visit) {
    constexpr int kCount = BrickLattice::kSize / size;
    detail::Walker walker(s.origin, s.direction, s.begin, size, ivec3(0), ivec3(kCount - 1));
    for (double t = s.begin; t < s.end;) {
        const double next = std::min(walker.exit(), s.end);
        if (next > t && !visit(VoxelSegment{s.brick, t, next, s.origin, s.direction, walker.cube}))
            return false;
        t = std::max(t, next);
        walker.advance();
        if (!detail::inside(walker.cube, ivec3(kCount)))
            break;
    }
    return true;
}

}  // namespace brisance
