#include "medium/medium.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "medium/lattice/node_fields.h"

namespace brisance {

namespace {

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

bool usable(const std::optional<BlockGrid>& grid) {
    return grid && !grid->empty();
}

// The grid whose lattice the medium takes: the finest of those in use, the first volume's density among equals.
const BlockGrid& finest(std::span<const MediumPart> parts, bool& half_voxel_shift) {
    const BlockGrid* best = nullptr;
    const auto offer = [&](const std::optional<BlockGrid>& grid, bool shift) {
        if (best && !(grid->info.voxel_volume() < 0.999 * best->info.voxel_volume()))
            return;
        best = &*grid;
        half_voxel_shift = shift;
    };
    for (const MediumPart& part : parts)
        for (const auto* g : {&part.grids.density, &part.grids.flame, &part.grids.temperature, &part.grids.colour})
            if (usable(*g))
                offer(*g, part.half_voxel_shift);
    for (const MediumPart& part : parts)
        for (const auto* g : {&part.grids.density, &part.grids.flame, &part.grids.temperature})
            if (*g && !best)
                offer(*g, part.half_voxel_shift);
    if (!best)
        throw Error(ExitCode::BadData, "no grid to render: map at least one of density, flame, temperature");
    return *best;
}

Sources open_sources(const MediumPart& part, const dmat4& world_from_target) {
    const auto open = [&](const std::optional<BlockGrid>& g) -> std::optional<SourceGrid> {
        if (!usable(g))
            return std::nullopt;
        return source_grid(*g, part.half_voxel_shift, world_from_target);
    };
    return {open(part.grids.density), open(part.grids.temperature), open(part.grids.flame),
            open(part.grids.colour),  open(part.grids.velocity),    part.settings};
}

void add_bricks(const Sources& sources, std::vector<ivec3>& bricks) {
    if (sources.density)
        add_bricks(*sources.density, bricks);
    if (sources.settings.fire.convention == EmissionConvention::Direct)
        for (const auto* s : {&sources.temperature, &sources.flame})
            if (*s)
                add_bricks(**s, bricks);
}

void set_transform(Medium& medium, std::span<const MediumPart> parts) {
    bool half_voxel_shift = false;
    const BlockGrid& grid = finest(parts, half_voxel_shift);
    medium.world_from_index = anchored(shifted(grid, half_voxel_shift));
    const dmat3 linear(medium.world_from_index);
    medium.local_from_index = mat3(linear);
    medium.index_from_local = mat3(glm::inverse(linear));
    medium.voxel_volume = static_cast<float>(std::abs(glm::determinant(linear)));
    medium.spacing = static_cast<float>(std::cbrt(std::abs(glm::determinant(linear))));
}

// Keeps only the bricks within one node of a node that absorbs, scatters or emits.
void trim(Medium& medium, const BrickLattice& lattice, NodeFields& f) {
    std::vector<std::uint8_t> marked(lattice.node_count());
    parallel_for(
        marked.size(),
        [&](std::size_t i) {
            marked[i] = f.extinction[i] > 0.0f || (!f.emission.empty() && f.emission[i] != Rgb(0.0f));
        },
        4096);
    medium.lattice = BrickLattice(bricks_around(lattice, marked, 1));
    const auto move = [&](auto& from, auto& to) {
        if (from.empty())
            return;
        to.resize(medium.lattice.node_count());
        parallel_for(
            medium.lattice.brick_count(),
            [&](std::size_t b) {
                const int old = lattice.find(medium.lattice.brick(b));
                if (old >= 0)
                    std::copy_n(&from[std::size_t(old) * BrickLattice::kNodes], BrickLattice::kNodes,
                                &to[b * BrickLattice::kNodes]);
            },
            16);
        from.clear();
        from.shrink_to_fit();
    };
    move(f.extinction, medium.extinction);
    move(f.source, medium.source);
    move(f.emission, medium.emission);
    move(f.albedo, medium.albedo_nodes);
    move(f.velocity, medium.velocity);
    medium.albedo = f.uniform_albedo;
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
           (source.size() + emission.size() + albedo_nodes.size()) * sizeof(Rgb) + velocity.size() * sizeof(vec3);
}

// Light transport sums products of these in single precision.
void check_range(const Medium& medium) {
    constexpr float most = 1e25f;
    const auto check = [&](float value, const char* what, const char* keys) {
        if (!(value <= most))
            throw Error(ExitCode::BadData, fmt::format("the {} at a voxel is {:g}, at most {:g} can be rendered: lower "
                                                       "{}, or look for damaged values with `brisance inspect`",
                                                       what, value, most, keys));
    };
    for (const float extinction : medium.extinction)
        check(extinction, "extinction", "smoke.extinction_per_metre");
    for (const auto* field : {&medium.source, &medium.emission})
        for (const Rgb& c : *field)
            check(std::max({c.x, c.y, c.z}), "fire's radiance", "fire.strength, fire.colour or fire.ramp");
}

Medium build_medium(std::span<const MediumPart> parts, Progress& progress) {
    for (const MediumPart& part : parts)
        report_odd_values(part.grids, progress);
    Medium medium;
    set_transform(medium, parts);
    medium.mean_cosine = parts[0].settings.smoke.mean_cosine;

    std::vector<Sources> sources;
    std::vector<ivec3> bricks;
    for (const MediumPart& part : parts) {
        sources.push_back(open_sources(part, medium.world_from_index));
        add_bricks(sources.back(), bricks);
    }
    const BrickLattice lattice(std::move(bricks));
    NodeFields fields = fill_fields(lattice, sources);
    trim(medium, lattice, fields);

    drop_zero_emission(medium);
    check_range(medium);
    for (float e : medium.extinction)
        medium.max_extinction = std::max(medium.max_extinction, e);
    // The middle of the bounding box to a multiple of 4096 nodes: local positions are small, do not depend on a frame's
    // exact bounds, and the reference is a node of every hierarchy level.
    const ivec3 middle = (medium.lattice.min_brick() * 2 + medium.lattice.brick_extent()) * (BrickLattice::kSize / 2);
    medium.reference_node = ((middle + 2048) >> 12) << 12;
    return medium;
}

Medium build_medium(const MediumGrids& grids, const MediumSettings& settings, bool half_voxel_shift,
                    Progress& progress) {
    return build_medium(std::vector{MediumPart{grids, settings, half_voxel_shift}}, progress);
}

}  // namespace brisance
