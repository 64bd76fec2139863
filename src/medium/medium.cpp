#include "medium/medium.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "medium/emission.h"

namespace brisance {

namespace {

// A BlockGrid seen as a field on a brick lattice: both store 8^3 nodes with z fastest, in the same order.
struct SourceGrid {
    const BlockGrid* grid;
    BrickLattice lattice;
    dmat4 index_from_target;     // this grid's index space from the medium's
    std::optional<ivec3> shift;  // set when the two lattices differ by whole nodes: this = target + shift
};

dmat4 shifted(const BlockGrid& grid, bool half_voxel_shift) {
    dmat4 m = grid.info.world_from_index;
    if (half_voxel_shift)
        m[3] = m * glm::dvec4(0.5, 0.5, 0.5, 1.0);
    return m;
}

// The transform re-indexed so that node 0 is the lattice point nearest the world's origin, up to a multiple of 2^20
// nodes that keeps indices small: lattices of every hierarchy level stay where they are in the world.
dmat4 anchored(const dmat4& world_from_index) {
    constexpr double period = 1 << 20;
    const dmat3 linear(world_from_index);
    dvec3 nodes = glm::round(glm::inverse(linear) * dvec3(world_from_index[3]));
    nodes -= period * glm::round(nodes / period);
    dmat4 m = world_from_index;
    m[3] = glm::dvec4(dvec3(m[3]) - linear * nodes, 1.0);
    return m;
}

SourceGrid source_grid(const BlockGrid& grid, bool half_voxel_shift, const dmat4& world_from_target) {
    SourceGrid s{&grid, {}, glm::inverse(shifted(grid, half_voxel_shift)) * world_from_target, {}};
    std::vector<ivec3> bricks;
    for (const ivec3& o : grid.block_origin)
        bricks.push_back(o >> 3);
    s.lattice = BrickLattice(std::move(bricks));
    // A whole shift, judged where the voxels are: at the corners of the grid's bricks.
    const dmat4 target_from_index = glm::inverse(s.index_from_target);
    const ivec3 first = s.lattice.min_brick() * BrickLattice::kSize;
    const dvec3 whole = glm::round(dvec3(first) - dvec3(target_from_index * glm::dvec4(dvec3(first), 1.0)));
    double deviation = 0.0;
    for (int k = 0; k < 8; ++k) {
        const dvec3 corner(first +
                           s.lattice.brick_extent() * BrickLattice::kSize * ivec3(k & 1, k >> 1 & 1, k >> 2 & 1));
        const dvec3 target(target_from_index * glm::dvec4(corner, 1.0));
        deviation = std::max(deviation, glm::length(corner - target - whole));
    }
    if (deviation < 1e-3)
        s.shift = ivec3(whole);
    return s;
}

float node_value(const SourceGrid& s, const ivec3& node, int channel) {
    const std::int64_t i = s.lattice.find_node(node);
    return i < 0 ? 0.0f : s.grid->values[i * s.grid->channels + channel];
}

float interpolated(const SourceGrid& s, const ivec3& target_node, int channel) {
    const dvec3 p = dvec3(s.index_from_target * glm::dvec4(dvec3(target_node), 1.0));
    const dvec3 base = glm::floor(p);
    const dvec3 f = p - base;
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
        const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
        const double w = (d.x ? f.x : 1 - f.x) * (d.y ? f.y : 1 - f.y) * (d.z ? f.z : 1 - f.z);
        if (w > 0.0)
            sum += w * node_value(s, ivec3(base) + d, channel);
    }
    return static_cast<float>(sum);
}

float read(const SourceGrid& s, const ivec3& target_node, int channel) {
    return s.shift ? node_value(s, target_node + *s.shift, channel) : interpolated(s, target_node, channel);
}

// Target bricks that the non-zero nodes of `s` can reach by interpolation: a block's corners, one node wider, mapped.
void add_bricks(const SourceGrid& s, std::vector<ivec3>& bricks) {
    const dmat4 target_from_index = glm::inverse(s.index_from_target);
    for (std::size_t b = 0; b < s.lattice.brick_count(); ++b) {
        dvec3 low(1e300), high(-1e300);
        for (int k = 0; k < 8; ++k) {
            const dvec3 corner = dvec3(s.lattice.first_node(b)) + dvec3(k & 1 ? 8 : -1, k & 2 ? 8 : -1, k & 4 ? 8 : -1);
            const dvec3 p(target_from_index * glm::dvec4(corner, 1.0));
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const ivec3 first = ivec3(glm::floor(low + 1e-6)) >> 3;
        const ivec3 last = ivec3(glm::ceil(high - 1e-6)) >> 3;
        for (int x = first.x; x <= last.x; ++x)
            for (int y = first.y; y <= last.y; ++y)
                for (int z = first.z; z <= last.z; ++z)
                    bricks.emplace_back(x, y, z);
    }
}

struct Sources {
    std::optional<SourceGrid> density, temperature, flame, colour;
};

// The grid whose lattice the medium takes: the finest of those in use, the density's among equals.
const BlockGrid& finest(const MediumGrids& grids) {
    const BlockGrid* best = nullptr;
    for (const auto* g : {&grids.density, &grids.flame, &grids.temperature, &grids.colour})
        if (*g && !(*g)->empty() && (!best || (*g)->info.voxel_volume() < 0.999 * best->info.voxel_volume()))
            best = &**g;
    if (best)
        return *best;
    for (const auto* g : {&grids.density, &grids.flame, &grids.temperature})
        if (*g)
            return **g;
    throw Error(ExitCode::BadData, "no grid to render: map at least one of density, flame, temperature");
}

Sources open_sources(const MediumGrids& grids, bool half_voxel_shift, const dmat4& world_from_target) {
    const auto open = [&](const std::optional<BlockGrid>& g) -> std::optional<SourceGrid> {
        if (!g || g->empty())
            return std::nullopt;
        return source_grid(*g, half_voxel_shift, world_from_target);
    };
    return {open(grids.density), open(grids.temperature), open(grids.flame), open(grids.colour)};
}

void set_transform(Medium& medium, const BlockGrid& grid, bool half_voxel_shift) {
    medium.world_from_index = anchored(shifted(grid, half_voxel_shift));
    const dmat3 linear(medium.world_from_index);
    medium.local_from_index = mat3(linear);
    medium.index_from_local = mat3(glm::inverse(linear));
    medium.voxel_volume = static_cast<float>(std::abs(glm::determinant(linear)));
    medium.spacing = static_cast<float>(std::cbrt(std::abs(glm::determinant(linear))));
}

struct NodeFields {
    std::vector<float> extinction;
    std::vector<Rgb> radiance;  // L_e, or j for the direct convention
    std::vector<Rgb> albedo;
};

NodeFields fill_fields(const BrickLattice& lattice, const Sources& sources, const MediumSettings& settings) {
    const bool fire = settings.fire.model != FireModel::None;
    const bool albedo_grid = sources.colour && settings.colour_role == ColourRole::Albedo;
    const SourceRadiance source_radiance(settings.fire);
    NodeFields f;
    f.extinction.resize(lattice.node_count());
    f.radiance.resize(fire ? lattice.node_count() : 0);
    f.albedo.resize(albedo_grid ? lattice.node_count() : 0);
    parallel_for(
        lattice.brick_count(),
        [&](std::size_t b) {
            for (int n = 0; n < BrickLattice::kNodes; ++n) {
                const ivec3 node = lattice.first_node(b) + BrickLattice::node_in_brick(n);
                const std::size_t i = b * BrickLattice::kNodes + n;
                if (sources.density)
                    f.extinction[i] =
                        settings.smoke.extinction_per_metre * std::max(0.0f, read(*sources.density, node, 0));
                Rgb colour(1.0f);
                if (sources.colour)
                    colour = glm::max(Rgb(read(*sources.colour, node, 0), read(*sources.colour, node, 1),
                                          read(*sources.colour, node, 2)),
                                      Rgb(0.0f));
                if (albedo_grid)
                    f.albedo[i] = glm::min(settings.smoke.albedo * colour, Rgb(1.0f));
                if (!fire)
                    continue;
                NodeValues v;
                if (sources.flame)
                    v.flame = read(*sources.flame, node, 0);
                if (sources.temperature)
                    v.temperature = read(*sources.temperature, node, 0);
                if (!albedo_grid)
                    v.colour = colour;
                f.radiance[i] = source_radiance(v);
            }
        },
        4);
    return f;
}

// Keeps only the bricks within one node of a node that absorbs, scatters or emits.
void trim(Medium& medium, const BrickLattice& lattice, NodeFields& f, bool direct) {
    std::vector<std::uint8_t> marked(lattice.node_count());
    for (std::size_t i = 0; i < marked.size(); ++i)
        marked[i] = f.extinction[i] > 0.0f || (direct && !f.radiance.empty() && f.radiance[i] != Rgb(0.0f));
    medium.lattice = BrickLattice(bricks_around(lattice, marked, 1));
    const auto move = [&](auto& from, auto& to) {
        if (from.empty())
            return;
        to.resize(medium.lattice.node_count());
        for (std::size_t b = 0; b < medium.lattice.brick_count(); ++b) {
            const int old = lattice.find(medium.lattice.brick(b));
            if (old >= 0)
                std::copy_n(&from[std::size_t(old) * BrickLattice::kNodes], BrickLattice::kNodes,
                            &to[b * BrickLattice::kNodes]);
        }
        from.clear();
        from.shrink_to_fit();
    };
    move(f.extinction, medium.extinction);
    move(f.radiance, direct ? medium.emission : medium.source);
    move(f.albedo, medium.albedo_nodes);
}

void drop_zero_emission(Medium& medium) {
    for (auto* field : {&medium.source, &medium.emission})
        if (std::all_of(field->begin(), field->end(), [](const Rgb& c) { return c == Rgb(0.0f); }))
            field->clear();
}

void report_odd_values(const MediumGrids& grids, Progress& progress) {
    for (const auto* g : {&grids.density, &grids.temperature, &grids.flame, &grids.colour}) {
        if (!*g)
            continue;
        const GridCensus& c = (*g)->census;
        const std::string name = "grid '" + (*g)->info.name + "'";
        if ((*g)->empty())
            progress.notice(name + " is empty (no active voxel, or all zero)");
        if (c.nan_voxels)
            progress.warning("nan", name + ": " + std::to_string(c.nan_voxels) + " NaN or infinite voxels read as 0");
        if (c.negative_voxels && g != &grids.temperature)
            progress.warning("negative",
                             name + ": " + std::to_string(c.negative_voxels) + " negative voxels read as 0");
    }
}

}  // namespace

bool Medium::scatters() const {
    if (max_extinction <= 0.0f)
        return false;
    if (albedo_nodes.empty())
        return albedo != Rgb(0.0f);
    return std::any_of(albedo_nodes.begin(), albedo_nodes.end(), [](const Rgb& a) { return a != Rgb(0.0f); });
}

dvec3 Medium::world_of_local(const vec3& p) const {
    return dvec3(world_from_index * glm::dvec4(dvec3(reference_node), 1.0)) + dvec3(p);
}

vec3 Medium::local_of_world(const dvec3& p) const {
    return vec3(p - dvec3(world_from_index * glm::dvec4(dvec3(reference_node), 1.0)));
}

std::uint64_t Medium::bytes() const {
    return lattice.bytes() + extinction.size() * sizeof(float) +
           (source.size() + emission.size() + albedo_nodes.size()) * sizeof(Rgb);
}

Medium build_medium(const MediumGrids& grids, const MediumSettings& settings, bool half_voxel_shift,
                    Progress& progress) {
    report_odd_values(grids, progress);
    Medium medium;
    set_transform(medium, finest(grids), half_voxel_shift);
    medium.albedo = settings.smoke.albedo;
    medium.mean_cosine = settings.smoke.mean_cosine;

    const Sources sources = open_sources(grids, half_voxel_shift, medium.world_from_index);
    const bool direct = settings.fire.convention == EmissionConvention::Direct;
    std::vector<ivec3> bricks;
    if (sources.density)
        add_bricks(*sources.density, bricks);
    if (direct)
        for (const auto* s : {&sources.temperature, &sources.flame})
            if (*s)
                add_bricks(**s, bricks);
    const BrickLattice lattice(std::move(bricks));
    NodeFields fields = fill_fields(lattice, sources, settings);
    trim(medium, lattice, fields, direct);

    for (std::size_t i = 0; i < medium.source.size(); ++i)
        medium.source[i] *= Rgb(1.0f) - medium.albedo_at(i);
    drop_zero_emission(medium);
    for (float e : medium.extinction)
        medium.max_extinction = std::max(medium.max_extinction, e);
    // The middle of the bounding box to a multiple of 4096 nodes: local positions are small, do not depend on a frame's
    // exact bounds, and the reference is a node of every hierarchy level.
    const ivec3 middle = (medium.lattice.min_brick() * 2 + medium.lattice.brick_extent()) * (BrickLattice::kSize / 2);
    medium.reference_node = ((middle + 2048) >> 12) << 12;
    return medium;
}

}  // namespace brisance
