#include "motion/moving_medium.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace brisance {

namespace {

// The nodes around a position and their trilinear weights; -1: outside of the lattice.
struct Corners {
    std::array<std::int64_t, 8> node;
    std::array<float, 8> weight;

    Corners(const BrickLattice& lattice, const ivec3& reference, const vec3& position) {
        const vec3 low = glm::floor(position), part = position - low;
        const ivec3 first = ivec3(low) + reference;
        for (int k = 0; k < 8; ++k) {
            const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
            node[k] = lattice.find_node(first + d);
            weight[k] =
                (d.x ? part.x : 1.0f - part.x) * (d.y ? part.y : 1.0f - part.y) * (d.z ? part.z : 1.0f - part.z);
        }
    }

    template <class T>
    T mean(const std::vector<T>& values) const {
        T sum(0.0f);
        for (int k = 0; k < 8; ++k)
            if (node[k] >= 0)
                sum += weight[k] * values[std::size_t(node[k])];
        return sum;
    }

    // Weighted by extinction, too; where there is none, the plain mean of the nodes that are there.
    Rgb mean_of_matter(const std::vector<Rgb>& values, const std::vector<float>& extinction) const {
        Rgb dense(0.0f), plain(0.0f);
        float of_dense = 0.0f, of_plain = 0.0f;
        for (int k = 0; k < 8; ++k) {
            if (node[k] < 0)
                continue;
            const std::size_t i = std::size_t(node[k]);
            const float w = weight[k] * extinction[i];
            dense += w * values[i];
            of_dense += w;
            plain += weight[k] * values[i];
            of_plain += weight[k];
        }
        return of_dense > 0.0f ? dense / of_dense : of_plain > 0.0f ? plain / of_plain : Rgb(0.0f);
    }
};

float fastest(const Medium& medium) {
    float square = 0.0f;
    for (std::size_t i = 0; i < medium.velocity.size(); ++i)
        if (medium.extinction[i] > 0.0f || !medium.emission.empty())
            square = std::max(square, glm::dot(medium.velocity[i], medium.velocity[i]));
    return std::sqrt(square);
}

// [nodes]
int reach_in_nodes(const Medium& medium, float metres) {
    const mat3& m = medium.index_from_local;
    const float most = std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
    return static_cast<int>(std::ceil(metres * most)) + 1;
}

// `values` of the medium at origins.
std::vector<Rgb> moved(const std::vector<Rgb>& values, const Medium& medium, const Origins& origins) {
    std::vector<Rgb> out(values.empty() ? 0 : origins.at_nodes.size());
    parallel_for(
        out.size(),
        [&](std::size_t i) {
            out[i] = Corners(medium.lattice, medium.reference_node, origins.at_nodes[i])
                         .mean_of_matter(values, medium.extinction);
        },
        512);
    return out;
}

template <class T>
void keep_bricks(const BrickLattice& from, const BrickLattice& to, std::vector<T>& values) {
    if (values.empty())
        return;
    std::vector<T> kept(to.node_count(), T(0.0f));
    for (std::size_t b = 0; b < to.brick_count(); ++b)
        if (const int old = from.find(to.brick(b)); old >= 0)
            std::copy_n(&values[std::size_t(old) * BrickLattice::kNodes], BrickLattice::kNodes,
                        &kept[b * BrickLattice::kNodes]);
    values = std::move(kept);
}

// Bricks without extinction and emission, and without a neighbour that has some, go.
void trim(Medium& medium) {
    std::vector<std::uint8_t> marked(medium.lattice.node_count());
    for (std::size_t i = 0; i < marked.size(); ++i)
        marked[i] = medium.extinction[i] > 0.0f || (!medium.emission.empty() && medium.emission[i] != Rgb(0.0f));
    const BrickLattice full = std::move(medium.lattice);
    medium.lattice = BrickLattice(bricks_around(full, marked, 1));
    keep_bricks(full, medium.lattice, medium.extinction);
    keep_bricks(full, medium.lattice, medium.source);
    keep_bricks(full, medium.lattice, medium.emission);
    keep_bricks(full, medium.lattice, medium.albedo_nodes);
}

}  // namespace

MovingMedium::MovingMedium(const Medium& medium, double reach)
    : medium_(medium),
      largest_distance_(fastest(medium) * float(reach)),
      around_(velocity_around(medium, reach_in_nodes(medium, largest_distance_))) {}

vec3 MovingMedium::velocity(const vec3& node) const {
    return Corners(around_.lattice, medium_.reference_node, node).mean(around_.at_nodes);
}

vec3 MovingMedium::origin(vec3 node, double frames) const {
    const float length = glm::length(velocity(node)) * float(std::abs(frames));
    const int steps = std::max(1, static_cast<int>(std::ceil(length)));
    const float step = float(frames / steps);
    for (int k = 0; k < steps; ++k)
        node -= step * velocity(node - 0.5f * step * velocity(node));
    return node;
}

Origins MovingMedium::origins(const BrickLattice& lattice, double frames) const {
    Origins out;
    out.at_nodes.resize(lattice.node_count());
    parallel_for(
        out.at_nodes.size(),
        [&](std::size_t i) { out.at_nodes[i] = origin(vec3(lattice.node(i) - medium_.reference_node), frames); }, 512);
    return out;
}

Medium MovingMedium::at(double frames) const {
    Medium out;
    out.lattice = around_.lattice;
    out.world_from_index = medium_.world_from_index;
    out.reference_node = medium_.reference_node;
    out.local_from_index = medium_.local_from_index;
    out.index_from_local = medium_.index_from_local;
    out.voxel_volume = medium_.voxel_volume;
    out.spacing = medium_.spacing;
    out.albedo = medium_.albedo;
    out.mean_cosine = medium_.mean_cosine;
    const Origins from = origins(out.lattice, frames);
    const auto plain_mean = [&](const auto& values, auto& to) {
        to.resize(values.empty() ? 0 : from.at_nodes.size());
        parallel_for(
            to.size(),
            [&](std::size_t i) {
                to[i] = Corners(medium_.lattice, medium_.reference_node, from.at_nodes[i]).mean(values);
            },
            512);
    };
    plain_mean(medium_.extinction, out.extinction);
    plain_mean(medium_.emission, out.emission);
    out.source = moved(medium_.source, medium_, from);
    out.albedo_nodes = moved(medium_.albedo_nodes, medium_, from);
    trim(out);
    for (const float e : out.extinction)
        out.max_extinction = std::max(out.max_extinction, e);
    return out;
}

NodeSources moved_sources(const NodeSources& sources, const Medium& from, const Origins& origins) {
    NodeSources out;
    for (auto part :
         {&NodeSources::single, &NodeSources::multiple, &NodeSources::from_surfaces, &NodeSources::from_emitters})
        out.*part = moved(sources.*part, from, origins);
    out.emitters_at_nodes = sources.emitters_at_nodes;
    return out;
}

}  // namespace brisance
