#include "medium_lighting/exterior/point_receivers.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Sorts points into cubes of four nodes inside the medium, of ever more with their distance from it: only coarse lights
// matter there.
class PointCubes {
public:
    explicit PointCubes(const Medium& medium) : medium_(medium) {
        const ivec3 first = (medium.lattice.min_brick() * BrickLattice::kSize) - medium.reference_node;
        low_ = vec3(first);
        high_ = vec3(first + medium.lattice.brick_extent() * BrickLattice::kSize);
    }

    std::uint64_t key(const vec3& local) const {
        const vec3 p = medium_.index_from_local * local;
        const vec3 outside = glm::max(glm::max(low_ - p, p - high_), vec3(0.0f));
        const float distance = glm::length(outside) / 8.0f;
        const int shift = 2 + std::clamp(distance > 1.0f ? std::ilogb(distance) + 1 : 0, 0, 24);
        const vec3 scaled = p / std::ldexp(1.0f, shift);
        const ivec3 cube = ivec3(glm::clamp(glm::floor(scaled), vec3(-(1 << 18)), vec3((1 << 18) - 1))) + (1 << 18);
        return std::uint64_t(shift) << 57 | std::uint64_t(cube.x) << 38 | std::uint64_t(cube.y) << 19 |
               std::uint64_t(cube.z);
    }

private:
    const Medium& medium_;
    vec3 low_, high_;  // of the medium, in nodes from the reference node
};

struct Keyed {
    std::uint64_t cube;
    std::uint32_t point;
};

std::vector<Keyed> sorted_by_cube(const Medium& medium, const std::vector<ReceiverPoint>& points) {
    std::vector<Keyed> keyed(points.size());
    const PointCubes cubes(medium);
    for (std::size_t i = 0; i < points.size(); ++i)
        keyed[i] = {cubes.key(points[i].local), std::uint32_t(i)};
    std::sort(keyed.begin(), keyed.end(),
              [](const Keyed& a, const Keyed& b) { return a.cube != b.cube ? a.cube < b.cube : a.point < b.point; });
    return keyed;
}

}  // namespace

Receivers point_receivers(const Medium& medium, const std::vector<ReceiverPoint>& points,
                          std::vector<std::uint32_t>& order) {
    const std::vector<Keyed> keyed = sorted_by_cube(medium, points);
    Receivers receivers;
    std::vector<vec3> positions, directions;
    for (std::size_t i = 0; i < keyed.size();) {
        positions.clear();
        directions.clear();
        std::size_t end = i;
        for (; end < keyed.size() && keyed[end].cube == keyed[i].cube; ++end) {
            positions.push_back(points[keyed[end].point].local);
            directions.push_back(points[keyed[end].point].toward);
            order.push_back(keyed[end].point);
        }
        receivers.add_block(positions, directions);
        while (order.size() < receivers.size())
            order.push_back(order.back());
        i = end;
    }
    return receivers;
}

}  // namespace brisance
