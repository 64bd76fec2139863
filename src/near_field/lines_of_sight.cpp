#include "near_field/lines_of_sight.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <tuple>

#include "medium/lattice/brick_lattice.h"

namespace brisance {

namespace {

constexpr int kRow = BrickLattice::kSize;

// Nodes along the side of parts whose edges are tested one by one.
constexpr int kSmallest = 2;

int steps_to(const ivec3& o) {
    return std::abs(o.x) + std::abs(o.y) + std::abs(o.z);
}

// Of each node of a box, its own flag and those of the next along z, as bits. `flags`: 0 or 1; ends with nodes that
// no row begins at.
std::vector<std::uint8_t> packed(const std::vector<std::uint8_t>& flags) {
    std::vector<std::uint8_t> bits(flags.size(), 0);
    for (std::size_t i = 0; i + kRow <= flags.size(); ++i)
        for (int k = 0; k < kRow; ++k)
            bits[i] |= std::uint8_t(flags[i + std::size_t(k)] << k);
    return bits;
}

}  // namespace

LinesOfSight::Stencil::Stencil(std::span<const ivec3> separations, int margin)
    : margin_(margin), wide_(kRow + 2 * margin) {
    std::vector<ivec3> nodes;
    for (int x = -margin; x <= margin; ++x)
        for (int y = -margin; y <= margin; ++y)
            for (int z = -margin; z <= margin; ++z)
                nodes.emplace_back(x, y, z);
    std::ranges::stable_sort(nodes, {}, steps_to);
    const auto key = [](const ivec3& o) { return std::tuple(o.x, o.y, o.z); };
    std::map<std::tuple<int, int, int>, int> number;
    const auto offset = [&](const ivec3& o) { return (o.x * wide_ + o.y) * wide_ + o.z; };
    for (const ivec3& o : nodes) {
        Cell cell{offset(o), {-1, -1, -1}, {0, 0, 0}};
        for (int a = 0; a < 3; ++a) {
            if (o[a] == 0)
                continue;
            ivec3 nearer = o;
            nearer[a] -= o[a] > 0 ? 1 : -1;
            cell.predecessor[a] = number.at(key(nearer));
            cell.edge[a] = offset(o[a] > 0 ? nearer : o);
        }
        number.emplace(key(o), int(cells_.size()));
        cells_.push_back(cell);
    }
    for (const ivec3& o : separations)
        separations_.push_back(static_cast<std::uint32_t>(number.at(key(o))));
}

// Of the nodes of a part of the box, whose lowest is `low`.
void LinesOfSight::close_edges(const ivec3& low, const ivec3& box, const ivec3& first, int size, Edges& edges,
                               bool& closed) const {
    const ivec3 end = glm::min(first + size, box);
    if (glm::any(glm::greaterThanEqual(first, end)))
        return;
    const vec3 from = vec3(low + first), to = vec3(low + end);  // one node more: edges reach there
    float radius = 0.0f;
    const vec3 middle = local(0.5f * (from + to));
    for (int k = 0; k < 8; ++k)
        radius = std::max(radius, glm::distance(middle, local(glm::mix(from, to, vec3(k >> 2, k >> 1 & 1, k & 1)))));
    if (!occluders_.any_within(middle, radius))
        return;
    if (size > kSmallest) {
        for (int k = 0; k < 8; ++k)
            close_edges(low, box, first + size / 2 * ivec3(k >> 2, k >> 1 & 1, k & 1), size / 2, edges, closed);
        return;
    }
    for (int x = first.x; x < end.x; ++x)
        for (int y = first.y; y < end.y; ++y)
            for (int z = first.z; z < end.z; ++z) {
                const ivec3 node(x, y, z);
                for (int a = 0; a < 3; ++a) {
                    ivec3 next = node;
                    ++next[a];
                    if (occluders_.visible(local(vec3(low + node)), local(vec3(low + next))))
                        continue;
                    edges[std::size_t(a)][std::size_t((x * box.y + y) * box.z + z)] = 0;
                    closed = true;
                }
            }
}

bool LinesOfSight::look(const Stencil& stencil, const ivec3& first_node, std::vector<std::uint8_t>& seen) const {
    const ivec3 box(stencil.wide_);
    const auto nodes = std::size_t(box.x) * std::size_t(box.y) * std::size_t(box.z);
    Edges edges;
    for (std::vector<std::uint8_t>& along : edges)
        along.assign(nodes, 1);
    bool closed = false;
    int size = 1;
    while (size < stencil.wide_)
        size *= 2;
    close_edges(first_node - stencil.margin_, box, ivec3(0), size, edges, closed);
    if (!closed)
        return false;
    const Edges open{packed(edges[0]), packed(edges[1]), packed(edges[2])};
    seen.resize(std::size_t(kRow) * kRow * stencil.separations_.size());
    std::vector<std::uint8_t> reached(stencil.cells_.size());
    auto out = seen.begin();
    for (int x = 0; x < kRow; ++x)
        for (int y = 0; y < kRow; ++y) {
            const int m = stencil.margin_, row = ((x + m) * stencil.wide_ + y + m) * stencil.wide_ + m;
            reached[0] = 0xff;
            for (std::size_t c = 1; c < stencil.cells_.size(); ++c) {
                const Stencil::Cell& cell = stencil.cells_[c];
                std::uint8_t bits = 0;
                for (std::size_t a = 0; a < 3; ++a)
                    if (cell.predecessor[a] >= 0)
                        bits |= reached[std::size_t(cell.predecessor[a])] & open[a][std::size_t(row + cell.edge[a])];
                reached[c] = bits;
            }
            for (const std::uint32_t c : stencil.separations_)
                *out++ = reached[c];
        }
    return true;
}

}  // namespace brisance
