#include "medium_lighting/levels/corners_seen.h"

#include <cmath>

#include "core/parallel.h"

namespace brisance {

namespace {

// Of the way to a corner: a surface that a node lies on hides nothing from it.
constexpr float kOwnSurface = 1e-3f;

// Nodes of a brick that stand for all: two in each layer along any axis.
constexpr int kSampledNodes = 16;

// A coarse cell, in nodes of the fine lattice.
struct CoarseCell {
    CoarseCell(const ivec3& node, int level) : level(level), base(node >> level) {}
    ivec3 corner(int k) const { return (base + ivec3(k >> 2, k >> 1 & 1, k & 1)) << level; }
    float weight(const ivec3& node, int k) const {
        const vec3 f = vec3(node - (base << level)) / float(1 << level);
        const vec3 w = glm::mix(1.0f - f, f, vec3(k >> 2, k >> 1 & 1, k & 1));
        return w.x * w.y * w.z;
    }

    int level;
    ivec3 base;
};

bool hidden(const Occluders& occluders, const vec3& from, const vec3& to) {
    const vec3 offset = to - from;
    const float distance = glm::length(offset);
    if (!(distance > 0.0f))
        return false;
    const float start = kOwnSurface * distance, way = distance - 2.0f * start;
    const vec3 direction = offset / distance;
    return occluders.first_hit(from + start * direction, direction, way) < way;
}

std::uint8_t seen_from(const Medium& fine, const ivec3& node, int level, const Occluders& occluders) {
    const CoarseCell cell(node, level);
    const vec3 from = fine.local_of_node(node);
    std::uint8_t seen = 0;
    for (int k = 0; k < 8; ++k)
        if (cell.weight(node, k) > 0.0f && !hidden(occluders, from, fine.local_of_node(cell.corner(k))))
            seen |= std::uint8_t(1 << k);
    return seen != 0 ? seen : CornersSeen::kAll;
}

// Whether a surface may come between nodes of a box and the corners of their cells.
bool may_be_cut(const Medium& fine, const ivec3& first, int side, int level, const Occluders& occluders) {
    const vec3 low = fine.local_of_node(first), high = fine.local_of_node(first + ivec3(side - 1));
    const float reach = std::sqrt(3.0f) * std::exp2(float(level)) * fine.spacing;
    return occluders.any_within(0.5f * (low + high), 0.5f * glm::distance(low, high) + reach);
}

// Parts of a brick that have their coarse cells to themselves.
int side_of_part(int level) {
    return std::min(1 << level, BrickLattice::kSize);
}

}  // namespace

CornersSeen::CornersSeen(const Medium& fine, int level, const Occluders& occluders)
    : bricks_(fine.lattice.brick_count()) {
    parallel_for(bricks_.size(), [&](std::size_t b) {
        const ivec3 first = fine.lattice.first_node(b);
        if (!may_be_cut(fine, first, BrickLattice::kSize, level, occluders))
            return;
        auto seen = std::make_unique<OfBrick>();
        seen->fill(kAll);
        const int side = side_of_part(level), parts = BrickLattice::kSize / side;
        std::vector<std::uint8_t> cut(std::size_t(parts) * parts * parts);
        const auto part_at = [&](const ivec3& p) { return ((p.x * parts) + p.y) * parts + p.z; };
        for (int x = 0; x < parts; ++x)
            for (int y = 0; y < parts; ++y)
                for (int z = 0; z < parts; ++z)
                    cut[part_at({x, y, z})] = may_be_cut(fine, first + side * ivec3(x, y, z), side, level, occluders);
        for (int k = 0; k < BrickLattice::kNodes; ++k)
            if (const ivec3 p = BrickLattice::node_in_brick(k); cut[part_at(p / side)])
                (*seen)[k] = seen_from(fine, first + p, level, occluders);
        bricks_[b] = std::move(seen);
    });
}

double part_beyond_surfaces(const Medium& fine, int level, const Occluders& occluders) {
    const std::size_t n = fine.lattice.brick_count();
    std::vector<double> beyond(n), all(n);
    parallel_for(n, [&](std::size_t b) {
        const float* const extinction = fine.extinction.data() + b * BrickLattice::kNodes;
        for (int k = 0; k < BrickLattice::kNodes; ++k)
            all[b] += extinction[k];
        const ivec3 first = fine.lattice.first_node(b);
        if (all[b] == 0.0 || !may_be_cut(fine, first, BrickLattice::kSize, level, occluders))
            return;
        double sum = 0.0, behind = 0.0;
        for (int s = 0; s < kSampledNodes; ++s) {
            const ivec3 part(s >> 2 & 1, s >> 1 & 1, s & 1), within(s & 3, s >> 2 & 3, s * 3 >> 2 & 3);
            const ivec3 p = 4 * part + within;
            const double weight = extinction[(p.x * BrickLattice::kSize + p.y) * BrickLattice::kSize + p.z];
            if (weight == 0.0)
                continue;
            const CoarseCell cell(first + p, level);
            const vec3 from = fine.local_of_node(first + p);
            sum += weight;
            for (int k = 0; k < 8; ++k)
                if (const float w = cell.weight(first + p, k);
                    w > 0.0f && hidden(occluders, from, fine.local_of_node(cell.corner(k))))
                    behind += weight * w;
        }
        beyond[b] = sum > 0.0 ? all[b] * behind / sum : 0.0;
    });
    double beyond_sum = 0.0, sum = 0.0;
    for (std::size_t b = 0; b < n; ++b) {
        beyond_sum += beyond[b];
        sum += all[b];
    }
    return sum > 0.0 ? beyond_sum / sum : 0.0;
}

}  // namespace brisance
