#include "near_field/lines_of_sight.h"

#include <algorithm>
#include <cstdlib>

#include "medium/lattice/brick_lattice.h"

namespace brisance {

namespace {

constexpr int kRow = BrickLattice::kSize;

// Nodes along the side of parts whose edges are tested one by one.
constexpr int kSmallest = 2;

int steps_to(const ivec3& o) {
    return std::abs(o.x) + std::abs(o.y) + std::abs(o.z);
}

std::size_t count(const ivec3& box) {
    return std::size_t(box.x) * std::size_t(box.y) * std::size_t(box.z);
}

// Of each node of a box, its own flag and those of the next along z, as bits. `flags`: 0 or 1. The last nodes, at which
// no row begins, have no bits.
void pack(const std::vector<std::uint8_t>& flags, std::vector<std::uint8_t>& bits) {
    bits.assign(flags.size(), 0);
    for (std::size_t i = 0; i + kRow <= flags.size(); ++i)
        for (int k = 0; k < kRow; ++k)
            bits[i] |= std::uint8_t(flags[i + std::size_t(k)] << k);
}

// The nodes of all boxes between a node and those at the separations, the nearest first: a step toward the node leads
// from each of them to another.
std::vector<ivec3> nodes_between(std::span<const ivec3> separations, const ivec3& margin) {
    const ivec3 wide = 2 * margin + 1;
    std::vector<std::uint8_t> between(count(wide), 0);
    const auto each = [&](const ivec3& low, const ivec3& high, const auto& f) {
        for (int x = low.x; x <= high.x; ++x)
            for (int y = low.y; y <= high.y; ++y)
                for (int z = low.z; z <= high.z; ++z)
                    f(ivec3(x, y, z),
                      between[std::size_t(((x + margin.x) * wide.y + y + margin.y) * wide.z + z + margin.z)]);
    };
    for (const ivec3& o : separations)
        each(glm::min(o, ivec3(0)), glm::max(o, ivec3(0)), [](const ivec3&, std::uint8_t& is) { is = 1; });
    std::vector<ivec3> nodes;
    each(-margin, margin, [&](const ivec3& o, std::uint8_t is) {
        if (is || o == ivec3(0))
            nodes.push_back(o);
    });
    std::ranges::stable_sort(nodes, {}, steps_to);
    return nodes;
}

}  // namespace

// Of the nodes of a box, along each axis: 1 where the edge from a node is open.
struct LinesOfSight::Edges {
    ivec3 low, box;
    std::array<std::vector<std::uint8_t>, 3> open, rows;  // `rows`: packed
    bool any_closed = false;

    void reset(const ivec3& first, const ivec3& size) {
        low = first;
        box = size;
        any_closed = false;
        for (std::vector<std::uint8_t>& along : open)
            along.assign(count(box), 1);
    }
    void pack_rows() {
        for (std::size_t a = 0; a < 3; ++a)
            pack(open[a], rows[a]);
    }
};

LinesOfSight::Stencil::Stencil(std::span<const ivec3> separations) {
    for (const ivec3& o : separations)
        margin_ = glm::max(margin_, glm::abs(o));
    box_ = kRow + 2 * margin_;
    const std::vector<ivec3> nodes = nodes_between(separations, margin_);
    const int middle = offset(margin_);
    std::vector<int> number(count(box_), -1);  // of cells, by the offset of their node from the lowest
    for (std::size_t c = 0; c < nodes.size(); ++c)
        number[std::size_t(middle + offset(nodes[c]))] = int(c);
    for (const ivec3& o : nodes) {
        Cell cell{{-1, -1, -1}, {0, 0, 0}};
        for (int a = 0; a < 3; ++a) {
            if (o[a] == 0)
                continue;
            ivec3 nearer = o;
            nearer[a] -= o[a] > 0 ? 1 : -1;
            cell.predecessor[std::size_t(a)] = number[std::size_t(middle + offset(nearer))];
            cell.edge[std::size_t(a)] = offset(o[a] > 0 ? nearer : o);
        }
        cells_.push_back(cell);
    }
    for (const ivec3& o : separations)
        separations_.push_back(static_cast<std::uint32_t>(number[std::size_t(middle + offset(o))]));
}

// Of the edges from nodes of a part of the lattice: they reach one node farther.
bool LinesOfSight::any_within(const ivec3& low, const ivec3& end) const {
    const vec3 from(low), to(end), middle = local(0.5f * (from + to));
    float radius = 0.0f;
    for (int k = 0; k < 8; ++k)
        radius = std::max(radius, glm::distance(middle, local(glm::mix(from, to, vec3(k >> 2, k >> 1 & 1, k & 1)))));
    return occluders_.any_within(middle, radius);
}

void LinesOfSight::close_edges(const ivec3& first, int size, Edges& edges) const {
    const ivec3 end = glm::min(first + size, edges.box);
    if (glm::any(glm::greaterThanEqual(first, end)) || !any_within(edges.low + first, edges.low + end))
        return;
    if (size > kSmallest) {
        for (int k = 0; k < 8; ++k)
            close_edges(first + size / 2 * ivec3(k >> 2, k >> 1 & 1, k & 1), size / 2, edges);
        return;
    }
    for (int x = first.x; x < end.x; ++x)
        for (int y = first.y; y < end.y; ++y)
            for (int z = first.z; z < end.z; ++z)
                for (int a = 0; a < 3; ++a) {
                    ivec3 next(x, y, z);
                    ++next[a];
                    if (occluders_.visible(local(vec3(edges.low + ivec3(x, y, z))), local(vec3(edges.low + next))))
                        continue;
                    edges.open[std::size_t(a)][std::size_t((x * edges.box.y + y) * edges.box.z + z)] = 0;
                    edges.any_closed = true;
                }
}

bool LinesOfSight::look(const Stencil& stencil, const ivec3& first_node, std::vector<std::uint8_t>& seen) const {
    const ivec3 low = first_node - stencil.margin_;
    if (!any_within(low, low + stencil.box_))
        return false;
    thread_local Edges edges;
    edges.reset(low, stencil.box_);
    int size = 1;
    while (size < std::max({stencil.box_.x, stencil.box_.y, stencil.box_.z}))
        size *= 2;
    close_edges(ivec3(0), size, edges);
    if (!edges.any_closed)
        return false;
    edges.pack_rows();
    seen.resize(std::size_t(kRow) * kRow * stencil.separations_.size());
    std::vector<std::uint8_t> reached(stencil.cells_.size());
    auto out = seen.begin();
    for (int x = 0; x < kRow; ++x)
        for (int y = 0; y < kRow; ++y) {
            const int row = stencil.offset(stencil.margin_ + ivec3(x, y, 0));
            reached[0] = 0xff;
            for (std::size_t c = 1; c < stencil.cells_.size(); ++c) {
                const Stencil::Cell& cell = stencil.cells_[c];
                std::uint8_t bits = 0;
                for (std::size_t a = 0; a < 3; ++a)
                    if (cell.predecessor[a] >= 0)
                        bits |=
                            reached[std::size_t(cell.predecessor[a])] & edges.rows[a][std::size_t(row + cell.edge[a])];
                reached[c] = bits;
            }
            for (const std::uint32_t c : stencil.separations_)
                *out++ = reached[c];
        }
    return true;
}

}  // namespace brisance
