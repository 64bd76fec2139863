#include "medium/lattice/node_fields.h"

#include <algorithm>

#include "core/parallel.h"
#include "medium/emission.h"

namespace brisance {

namespace {

Rgb colour_at(const Sources& s, const ivec3& node) {
    if (!s.colour)
        return Rgb(1.0f);
    return glm::max(Rgb(read(*s.colour, node, 0), read(*s.colour, node, 1), read(*s.colour, node, 2)), Rgb(0.0f));
}

void fill_node(const Sources& s, const SourceRadiance& source_radiance, const ivec3& node, std::size_t i,
               NodeFields& f) {
    if (s.density)
        f.extinction[i] = s.settings.smoke.extinction_per_metre * std::max(0.0f, read(*s.density, node, 0));
    const Rgb colour = colour_at(s, node);
    if (!f.albedo.empty())
        f.albedo[i] = glm::min(s.settings.smoke.albedo * colour, Rgb(1.0f));
    if (!f.velocity.empty())
        f.velocity[i] = vec3(read(*s.velocity, node, 0), read(*s.velocity, node, 1), read(*s.velocity, node, 2));
    if (f.source.empty() && f.emission.empty())
        return;
    NodeValues v;
    if (s.flame)
        v.flame = read(*s.flame, node, 0);
    if (s.temperature)
        v.temperature = read(*s.temperature, node, 0);
    if (f.albedo.empty())
        v.colour = colour;
    const Rgb radiance = source_radiance(v);
    if (!f.emission.empty())
        f.emission[i] = radiance;
    else
        f.source[i] = radiance * (Rgb(1.0f) - (f.albedo.empty() ? f.uniform_albedo : f.albedo[i]));
}

NodeFields fields_of(const BrickLattice& lattice, const Sources& s) {
    const bool fire = s.settings.fire.model != FireModel::None;
    const bool direct = s.settings.fire.convention == EmissionConvention::Direct;
    NodeFields f;
    f.uniform_albedo = s.settings.smoke.albedo;
    f.extinction.resize(lattice.node_count());
    f.source.resize(fire && !direct ? lattice.node_count() : 0);
    f.emission.resize(fire && direct ? lattice.node_count() : 0);
    f.albedo.resize(s.colour && s.settings.colour_role == ColourRole::Albedo ? lattice.node_count() : 0);
    f.velocity.resize(s.velocity ? lattice.node_count() : 0);
    const SourceRadiance source_radiance(s.settings.fire);
    parallel_for(
        lattice.brick_count(),
        [&](std::size_t b) {
            for (int n = 0; n < BrickLattice::kNodes; ++n)
                fill_node(s, source_radiance, lattice.first_node(b) + BrickLattice::node_in_brick(n),
                          b * BrickLattice::kNodes + n, f);
        },
        4);
    return f;
}

// What a node without extinction lends to the voxels around it is of whatever smoke is beside it.
float extinction_around(const BrickLattice& lattice, const std::vector<float>& extinction, const ivec3& node) {
    float sum = 0.0f;
    for (int k = 0; k < 27; ++k) {
        const std::int64_t i = lattice.find_node(node + ivec3(k / 9, k / 3 % 3, k % 3) - 1);
        if (i >= 0)
            sum += extinction[i];
    }
    return sum;
}

// The second volume's part in means at a node.
float second_part(const BrickLattice& lattice, const NodeFields& a, const NodeFields& b, const ivec3& node,
                  std::size_t i) {
    float wa = a.extinction[i], wb = b.extinction[i];
    if (wa + wb == 0.0f) {
        wa = extinction_around(lattice, a.extinction, node);
        wb = extinction_around(lattice, b.extinction, node);
    }
    return wa + wb > 0.0f ? wb / (wa + wb) : 0.5f;
}

void give_every_node(std::vector<vec3>& field, std::size_t nodes, const vec3& value) {
    if (field.empty())
        field.assign(nodes, value);
}

// Sums `b` into `a`.
void add_fields(const BrickLattice& lattice, NodeFields& a, NodeFields& b) {
    const std::size_t nodes = lattice.node_count();
    if (!a.albedo.empty() || !b.albedo.empty() || a.uniform_albedo != b.uniform_albedo)
        for (NodeFields* f : {&a, &b})
            give_every_node(f->albedo, nodes, f->uniform_albedo);
    if (!a.source.empty() || !b.source.empty())
        for (NodeFields* f : {&a, &b})
            give_every_node(f->source, nodes, Rgb(0.0f));
    if (!a.velocity.empty() || !b.velocity.empty())
        for (NodeFields* f : {&a, &b})
            give_every_node(f->velocity, nodes, vec3(0.0f));
    if (!b.emission.empty())
        give_every_node(a.emission, nodes, Rgb(0.0f));
    if (!a.albedo.empty() || !a.source.empty() || !a.velocity.empty())
        parallel_for(lattice.brick_count(), [&](std::size_t brick) {
            for (int n = 0; n < BrickLattice::kNodes; ++n) {
                const std::size_t i = brick * BrickLattice::kNodes + n;
                const ivec3 node = lattice.first_node(brick) + BrickLattice::node_in_brick(n);
                const float t = second_part(lattice, a, b, node, i);
                if (!a.albedo.empty())
                    a.albedo[i] = glm::mix(a.albedo[i], b.albedo[i], t);
                if (!a.source.empty())
                    a.source[i] = glm::mix(a.source[i], b.source[i], t);
                if (!a.velocity.empty())
                    a.velocity[i] = glm::mix(a.velocity[i], b.velocity[i], t);
            }
        });
    for (std::size_t i = 0; i < nodes; ++i)
        a.extinction[i] += b.extinction[i];
    for (std::size_t i = 0; i < b.emission.size(); ++i)
        a.emission[i] += b.emission[i];
}

}  // namespace

NodeFields fill_fields(const BrickLattice& lattice, std::span<const Sources> volumes) {
    NodeFields sum = fields_of(lattice, volumes[0]);
    for (const Sources& s : volumes.subspan(1)) {
        NodeFields next = fields_of(lattice, s);
        add_fields(lattice, sum, next);
    }
    return sum;
}

}  // namespace brisance
