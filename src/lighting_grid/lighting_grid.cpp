#include "lighting_grid/lighting_grid.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "core/parallel.h"
#include "medium/lattice/extinction_pyramid.h"

namespace brisance {

namespace {

// Moments of the lights that a vertex represents, about the vertex, in level-0 nodes.
struct Moments {
    Rgb intensity{0.0f};
    float weight = 0.0f;
    vec3 first{0.0f};

    // Adds `share` of other moments whose vertex lies at `shift` from this one.
    void add(const Moments& m, float share, const vec3& shift) {
        intensity += share * m.intensity;
        const float w = share * m.weight;
        first += share * m.first + w * shift;
        weight += w;
    }
};

struct MomentField {
    BrickLattice lattice;
    std::vector<Moments> nodes;
};

// The moments of level 0: single lights at the nodes.
struct PointMoments {
    const BrickLattice& lattice;
    const std::vector<Rgb>& intensity;
    const std::vector<float>* weight;

    Moments operator()(std::int64_t i) const {
        Moments m;
        m.intensity = intensity[i];
        m.weight = weight ? (*weight)[i] : luminance(intensity[i]);
        return m;
    }
};

// By trilinear refinement the hat of a coarse vertex is the sum of fine hats with weights 1/2, 1, 1/2 per axis. Coarse
// moments are therefore the same sum of fine moments, shifted to the coarse vertex.
template <class Fine>
MomentField coarser(const BrickLattice& fine_lattice, const Fine& fine, float fine_spacing) {
    MomentField coarse;
    coarse.lattice = coarse_lattice(fine_lattice);
    coarse.nodes.resize(coarse.lattice.node_count());
    parallel_for(coarse.lattice.brick_count(), [&](std::size_t b) {
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const ivec3 vertex = coarse.lattice.first_node(b) + BrickLattice::node_in_brick(n);
            Moments& m = coarse.nodes[b * BrickLattice::kNodes + n];
            for (int k = 0; k < 27; ++k) {
                const ivec3 d(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1);
                const std::int64_t i = fine_lattice.find_node(vertex * 2 + d);
                if (i < 0)
                    continue;
                const Moments f = fine(i);
                if (f.weight > 0.0f)
                    m.add(f, 1.0f / float(1 << (d.x * d.x + d.y * d.y + d.z * d.z)), vec3(d) * fine_spacing);
            }
        }
    });
    return coarse;
}

GridLevel level_from(const Medium& medium, const MomentField& field, int number) {
    GridLevel level;
    level.level = number;
    level.spacing = medium.spacing * float(1 << number);
    level.lattice = field.lattice;
    std::vector<std::pair<ivec3, std::uint32_t>> found;
    for (std::size_t i = 0; i < field.nodes.size(); ++i)
        if (field.nodes[i].weight > 0.0f)
            found.emplace_back(field.lattice.node(i), static_cast<std::uint32_t>(i));
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return std::tie(a.first.x, a.first.y, a.first.z) < std::tie(b.first.x, b.first.y, b.first.z);
    });
    const std::size_t n = found.size();
    level.vertex.resize(n);
    level.position.resize(n);
    level.intensity.resize(n);
    level.node.resize(n);
    parallel_for(
        n,
        [&](std::size_t k) {
            const Moments& m = field.nodes[found[k].second];
            const vec3 mean = m.first / m.weight;
            level.vertex[k] = found[k].first;
            level.node[k] = found[k].second;
            level.position[k] = medium.local_of_node(found[k].first * (1 << number)) + medium.local_from_index * mean;
            level.intensity[k] = m.intensity;
        },
        256);
    level.index_rows();
    return level;
}

}  // namespace

void GridLevel::index_rows() {
    if (vertex.empty())
        return;
    ivec3 high = min_vertex = vertex.front();
    for (const ivec3& v : vertex) {
        min_vertex = glm::min(min_vertex, v);
        high = glm::max(high, v);
    }
    vertex_extent = high - min_vertex + 1;
    row_begin.assign(std::size_t(vertex_extent.x) * vertex_extent.y + 1, 0);
    for (const ivec3& v : vertex)
        ++row_begin[std::size_t(v.x - min_vertex.x) * vertex_extent.y + (v.y - min_vertex.y) + 1];
    for (std::size_t r = 1; r < row_begin.size(); ++r)
        row_begin[r] += row_begin[r - 1];
}

std::uint64_t GridLevel::bytes() const {
    return size() * (sizeof(ivec3) + sizeof(vec3) + sizeof(Rgb) + 4) + row_begin.size() * 4 + lattice.bytes() +
           part.size() * sizeof(vec3) + first_part.size() * 4 + ball.size() * sizeof(LightBall) +
           escaping.size() * sizeof(float);
}

void GridLevel::find_in_box(const ivec3& low, const ivec3& high, std::vector<std::uint32_t>& found) const {
    if (vertex.empty())
        return;
    const ivec3 from = glm::max(low - min_vertex, ivec3(0));
    const ivec3 to = glm::min(high - min_vertex, vertex_extent - 1);
    for (int x = from.x; x <= to.x; ++x)
        for (int y = from.y; y <= to.y; ++y) {
            const std::size_t row = std::size_t(x) * vertex_extent.y + y;
            for (std::uint32_t i = row_begin[row]; i < row_begin[row + 1] && vertex[i].z <= high.z; ++i)
                if (vertex[i].z >= low.z)
                    found.push_back(i);
        }
}

std::uint64_t LightingGrid::bytes() const {
    std::uint64_t sum = 0;
    for (const GridLevel& level : levels)
        sum += level.bytes();
    return sum;
}

LightingGrid build_lighting_grid(const Medium& medium, const std::vector<Rgb>& intensity,
                                 const std::vector<float>* weight, int levels) {
    LightingGrid grid;
    if (intensity.empty() || levels < 1)
        return grid;
    MomentField field = coarser(medium.lattice, PointMoments{medium.lattice, intensity, weight}, 1.0f);
    grid.levels.push_back(level_from(medium, field, 1));
    for (int l = 2; l <= levels; ++l) {
        field = coarser(
            field.lattice, [&](std::int64_t i) -> const Moments& { return field.nodes[i]; }, float(1 << (l - 1)));
        grid.levels.push_back(level_from(medium, field, l));
    }
    return grid;
}

namespace {

// Splats `channels` values per node to every level in turn and hands each level its sums.
template <class Take>
void splat(LightingGrid& grid, const BrickLattice& lattice, std::vector<float> values, int channels, const Take& take) {
    const BrickLattice* fine = &lattice;
    for (GridLevel& level : grid.levels) {
        BrickLattice coarse;
        std::vector<float> sums;
        coarsen(*fine, values, channels, coarse, sums);
        for (float& v : sums)
            v *= 8.0f;  // coarsen averages with the same weights, an eighth as large
        for (std::size_t k = 0; k < level.size(); ++k)
            take(level, k, &sums[std::size_t(level.node[k]) * channels]);
        values = std::move(sums);
        fine = &level.lattice;
    }
}

}  // namespace

void set_intensity(LightingGrid& grid, const BrickLattice& lattice, const std::vector<Rgb>& intensity,
                   const std::vector<float>* directional) {
    const auto* flat = reinterpret_cast<const float*>(intensity.data());
    splat(grid, lattice, std::vector<float>(flat, flat + intensity.size() * 3), 3,
          [](GridLevel& level, std::size_t k, const float* v) {
              level.intensity[k] = {v[0], v[1], v[2]};
          });
    for (GridLevel& level : grid.levels)
        level.directional.assign(directional ? level.size() * 24 : 0, 0.0f);
    if (directional)
        splat(grid, lattice, *directional, 24,
              [](GridLevel& level, std::size_t k, const float* v) { std::copy_n(v, 24, &level.directional[k * 24]); });
}

int automatic_levels(const Medium& medium) {
    const ivec3 e = medium.lattice.brick_extent() * BrickLattice::kSize;
    const int nodes = std::max({e.x, e.y, e.z, 1});
    int levels = 1;
    while (levels < 9 && nodes > 5 << levels)
        ++levels;
    return levels;
}

}  // namespace brisance
