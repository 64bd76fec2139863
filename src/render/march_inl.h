// Implementation of walk_cells: two nested digital differential analysers, over bricks and over cells.
#pragma once

#include <algorithm>
#include <limits>

namespace brisance::detail {

// Amanatides and Woo, A Fast Voxel Traversal Algorithm for Ray Tracing, Eurographics 1987; cells of `size` nodes.
class Walker {
public:
    Walker(const dvec3& origin, const dvec3& direction, double begin, double size, const ivec3& low, const ivec3& high)
        : origin_(origin), direction_(direction), size_(size) {
        for (int a = 0; a < 3; ++a) {
            const double p = (origin[a] + direction[a] * begin) / size;
            cell[a] = std::clamp(static_cast<int>(std::floor(p)), low[a], high[a]);
            // Exactly on a face the cell ahead is the one the ray is about to enter.
            if (direction[a] < 0.0 && p == std::floor(p) && cell[a] > low[a] && p == cell[a])
                --cell[a];
            crossing_[a] = next_crossing(a);
        }
    }

    ivec3 cell{0};

    double exit() const { return std::min({crossing_.x, crossing_.y, crossing_.z}); }

    void advance() {
        const int a =
            crossing_.x <= crossing_.y ? (crossing_.x <= crossing_.z ? 0 : 2) : (crossing_.y <= crossing_.z ? 1 : 2);
        cell[a] += direction_[a] > 0.0 ? 1 : -1;
        crossing_[a] = next_crossing(a);
    }

private:
    double next_crossing(int a) const {
        if (direction_[a] == 0.0)
            return std::numeric_limits<double>::infinity();
        return ((cell[a] + (direction_[a] > 0.0 ? 1 : 0)) * size_ - origin_[a]) / direction_[a];
    }

    dvec3 origin_, direction_, crossing_{0.0};
    double size_;
};

// Clips [begin, end] to the box [low, high] in nodes. False: missed.
inline bool clip(const dvec3& origin, const dvec3& direction, const dvec3& low, const dvec3& high, double& begin,
                 double& end) {
    for (int a = 0; a < 3; ++a) {
        if (direction[a] == 0.0) {
            if (origin[a] < low[a] || origin[a] > high[a])
                return false;
            continue;
        }
        const double t0 = (low[a] - origin[a]) / direction[a];
        const double t1 = (high[a] - origin[a]) / direction[a];
        begin = std::max(begin, std::min(t0, t1));
        end = std::min(end, std::max(t0, t1));
    }
    return begin < end;
}

}  // namespace brisance::detail

namespace brisance {

template <class Visit>
void walk_cells(const CellField& field, const Ray& ray, const Visit& visit) {
    const BrickLattice& bricks = field.bricks();
    if (bricks.empty())
        return;
    constexpr int kSize = BrickLattice::kSize;
    const Medium& medium = field.medium();
    const glm::dmat3 index_from_local(glm::inverse(dmat3(medium.world_from_index)));
    const ivec3 low = bricks.min_brick();
    const ivec3 count = bricks.brick_extent();
    // In nodes from the lowest brick's first node.
    const dvec3 origin = index_from_local * ray.origin + dvec3(medium.reference_node - low * kSize);
    const dvec3 direction = index_from_local * ray.direction;
    double begin = 0.0, end = std::numeric_limits<double>::infinity();
    if (!detail::clip(origin, direction, dvec3(0.0), dvec3(count * kSize), begin, end))
        return;
    detail::Walker over_bricks(origin, direction, begin, kSize, ivec3(0), count - 1);
    while (begin < end) {
        const ivec3 b = over_bricks.cell;
        const double leave = std::min(over_bricks.exit(), end);
        const int brick = bricks.find(low + b);
        if (brick >= 0 && leave > begin) {
            const dvec3 first(b * kSize);
            detail::Walker over_cells(origin, direction, begin, 1.0, b * kSize, b * kSize + kSize - 1);
            for (double t = begin; t < leave;) {
                const double next = std::min(over_cells.exit(), leave);
                if (next > t && !visit(CellSegment{std::size_t(brick), t, next, origin - first, direction}))
                    return;
                t = std::max(t, next);
                over_cells.advance();
                const ivec3 c = over_cells.cell - b * kSize;
                if (std::min({c.x, c.y, c.z}) < 0 || std::max({c.x, c.y, c.z}) >= kSize)
                    break;
            }
        }
        begin = std::max(begin, leave);
        over_bricks.advance();
        const ivec3 n = over_bricks.cell;
        if (std::min({n.x, n.y, n.z}) < 0 || n.x >= count.x || n.y >= count.y || n.z >= count.z)
            return;
    }
}

}  // namespace brisance
