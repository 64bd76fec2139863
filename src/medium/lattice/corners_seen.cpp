#include "medium/lattice/corners_seen.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "medium/lattice/brick_masks.h"

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

// Whether a surface may come between nodes of a box and the corners of their cells. `spacing`: of the nodes [m].
bool may_be_cut(const vec3& low, const vec3& high, float spacing, int level, const Occluders& occluders) {
    const float reach = std::sqrt(3.0f) * std::exp2(float(level)) * spacing;
    return occluders.any_within(0.5f * (low + high), 0.5f * glm::distance(low, high) + reach);
}

// Parts of a brick that have their coarse cells to themselves.
int side_of_part(int level) {
    return std::min(1 << level, BrickLattice::kSize);
}

}  // namespace

// The nodes that look for corners.
class CornersSeen::FineNodes {
public:
    FineNodes(const Medium& medium, const BrickLattice& lattice, int coarsening,
              const std::vector<std::uint8_t>* needed)
        : medium_(medium), lattice_(lattice), coarsening_(coarsening), needed_(needed) {}

    const BrickLattice& lattice() const { return lattice_; }
    vec3 local(const ivec3& node) const { return medium_.local_of_node(node * (1 << coarsening_)); }
    bool may_be_cut(const ivec3& first, int side, int level, const Occluders& occluders) const {
        return brisance::may_be_cut(local(first), local(first + ivec3(side - 1)),
                                    std::exp2(float(coarsening_)) * medium_.spacing, level, occluders);
    }
    bool asks(std::size_t node) const { return !needed_ || (*needed_)[node] != 0; }
    bool brick_asks(std::size_t brick) const { return !needed_ || any_in_brick(*needed_, brick); }

    std::uint8_t seen_from(const ivec3& node, int level, const Occluders& occluders) const {
        const CoarseCell cell(node, level);
        const vec3 from = local(node);
        std::uint8_t seen = 0;
        for (int k = 0; k < 8; ++k)
            if (cell.weight(node, k) == 0.0f || !hidden(occluders, from, local(cell.corner(k))))
                seen |= std::uint8_t(1 << k);
        return seen;
    }

private:
    const Medium& medium_;
    const BrickLattice& lattice_;
    int coarsening_;
    const std::vector<std::uint8_t>* needed_;
};

CornersSeen::CornersSeen(const Medium& fine, int level, const Occluders& occluders)
    : bricks_(fine.lattice.brick_count()) {
    find({fine, fine.lattice, 0, nullptr}, level, occluders);
}

CornersSeen::CornersSeen(const Medium& medium, const BrickLattice& lattice, int coarsening,
                         const std::vector<std::uint8_t>& needed, int level, const Occluders& occluders)
    : bricks_(lattice.brick_count()) {
    find({medium, lattice, coarsening, &needed}, level, occluders);
}

void CornersSeen::find(const FineNodes& fine, int level, const Occluders& occluders) {
    parallel_for(bricks_.size(), [&](std::size_t b) {
        const ivec3 first = fine.lattice().first_node(b);
        if (!fine.brick_asks(b) || !fine.may_be_cut(first, BrickLattice::kSize, level, occluders))
            return;
        auto seen = std::make_unique<OfBrick>();
        seen->fill(kAll);
        const int side = side_of_part(level), parts = BrickLattice::kSize / side;
        std::vector<std::uint8_t> cut(std::size_t(parts) * parts * parts);
        const auto part_at = [&](const ivec3& p) { return ((p.x * parts) + p.y) * parts + p.z; };
        for (int x = 0; x < parts; ++x)
            for (int y = 0; y < parts; ++y)
                for (int z = 0; z < parts; ++z)
                    cut[part_at({x, y, z})] = fine.may_be_cut(first + side * ivec3(x, y, z), side, level, occluders);
        for (int k = 0; k < BrickLattice::kNodes; ++k)
            if (const ivec3 p = BrickLattice::node_in_brick(k);
                cut[part_at(p / side)] && fine.asks(b * BrickLattice::kNodes + std::size_t(k)))
                (*seen)[k] = fine.seen_from(first + p, level, occluders);
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
        if (all[b] == 0.0 ||
            !may_be_cut(fine.local_of_node(first), fine.local_of_node(first + ivec3(BrickLattice::kSize - 1)),
                        fine.spacing, level, occluders))
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
