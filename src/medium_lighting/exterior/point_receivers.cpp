#include "medium_lighting/exterior/point_receivers.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace brisance {

namespace {

// Levels by which cubes may be larger than their smallest, where they hold few points.
constexpr int kLargerCubes = 2;
// More points are better off in smaller cubes.
constexpr std::size_t kPointsInACube = 4 * Receivers::kGroup;

// Sorts points into cubes of four nodes inside the medium, of ever more with their distance from it: only coarse lights
// matter there.
class PointCubes {
public:
    explicit PointCubes(const Medium& medium) : medium_(medium) {
        const ivec3 first = (medium.lattice.min_brick() * BrickLattice::kSize) - medium.reference_node;
        low_ = vec3(first);
        high_ = vec3(first + medium.lattice.brick_extent() * BrickLattice::kSize);
    }

    // `larger`: levels above the smallest cube at that place.
    std::uint64_t key(const vec3& local, int larger) const {
        const vec3 p = medium_.index_from_local * local;
        const vec3 outside = glm::max(glm::max(low_ - p, p - high_), vec3(0.0f));
        const float distance = glm::length(outside) / 8.0f;
        const int shift = 2 + larger + std::clamp(distance > 1.0f ? std::ilogb(distance) + 1 : 0, 0, 24);
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

// Points in the order of their blocks.
class PointBlocks {
public:
    PointBlocks(const Medium& medium, const std::vector<ReceiverPoint>& points) : points_(points), cubes_(medium) {
        keyed_.resize(points.size());
        for (std::uint32_t i = 0; i < points.size(); ++i)
            keyed_[i].point = i;
        split(keyed_, kLargerCubes);
    }
    const std::vector<std::span<const Keyed>>& blocks() const { return blocks_; }

private:
    void split(std::span<Keyed> some, int larger) {
        for (Keyed& k : some)
            k.cube = cubes_.key(points_[k.point].local, larger);
        std::sort(some.begin(), some.end(), [](const Keyed& a, const Keyed& b) {
            return a.cube != b.cube ? a.cube < b.cube : a.point < b.point;
        });
        for (std::size_t i = 0, end = 0; i < some.size(); i = end) {
            while (end < some.size() && some[end].cube == some[i].cube)
                ++end;
            if (larger > 0 && end - i > kPointsInACube)
                split(some.subspan(i, end - i), larger - 1);
            else
                blocks_.push_back(some.subspan(i, end - i));
        }
    }

    const std::vector<ReceiverPoint>& points_;
    PointCubes cubes_;
    std::vector<Keyed> keyed_;
    std::vector<std::span<const Keyed>> blocks_;
};

}  // namespace

Receivers point_receivers(const Medium& medium, const std::vector<ReceiverPoint>& points,
                          std::vector<std::uint32_t>& order) {
    const PointBlocks sorted(medium, points);
    Receivers receivers;
    std::vector<vec3> positions, directions;
    for (const std::span<const Keyed>& block : sorted.blocks()) {
        positions.clear();
        directions.clear();
        for (const Keyed& k : block) {
            positions.push_back(points[k.point].local);
            directions.push_back(points[k.point].toward);
            order.push_back(k.point);
        }
        receivers.add_block(positions, directions);
        while (order.size() < receivers.size())
            order.push_back(order.back());
    }
    return receivers;
}

}  // namespace brisance
