// One frame's participating medium: optical coefficients on one lattice, made for sampling.
//
// Everything lies on the lattice of the finest grid used. Grids on other lattices, and those of further volumes, are
// resampled onto it. Fields are trilinear between nodes and zero outside every brick. Two products make the light:
//   emitted    j(x)   = extinction(x) * source(x) + emission(x)     [W/(m^3 sr)]
//   scattered  s(x)   = extinction(x) * (albedo * fluence / 4 pi)(x)
// each factor interpolated on its own. Thresholds, ramps and black-body curves act on node values, before
// interpolation, and lights are integrals of these same fields, so that what the camera sees is what lights the smoke.
//
// Index space is anchored to the world: node (0,0,0) is the lattice point nearest the world's origin, so a moving
// domain does not move any lattice built on it. Positions "local" are metres from `reference_node`, axes parallel to
// the world's: small numbers even when the volume is 10^6 m from the origin.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/vec.h"
#include "medium/lattice/brick_lattice.h"
#include "medium/settings.h"
#include "volume/vdb_file.h"

namespace brisance {

struct MediumGrids {
    std::optional<BlockGrid> density;
    std::optional<BlockGrid> temperature;
    std::optional<BlockGrid> flame;
    std::optional<BlockGrid> colour;
    std::optional<BlockGrid> velocity;  // of the world's axes [m per frame]; on any lattice
};

struct Medium {
    BrickLattice lattice;
    dmat4 world_from_index{1.0};  // of the anchored index space
    ivec3 reference_node{0};
    mat3 local_from_index{1.0f};  // linear part [m per node]
    mat3 index_from_local{1.0f};
    float voxel_volume = 1.0f;  // [m^3]
    float spacing = 1.0f;       // cube root of voxel_volume [m]

    std::vector<float> extinction;  // per node [1/m]
    std::vector<Rgb> source;        // per node, thermal source function (1 - albedo) L_e [W/(m^2 sr)]; empty: none
    std::vector<Rgb> emission;      // per node, emission coefficient [W/(m^3 sr)]; empty: none
    std::vector<Rgb> albedo_nodes;  // per node; empty: `albedo` everywhere
    std::vector<vec3> velocity;     // per node [m per frame]; empty: nothing moves
    Rgb albedo{0.0f};
    float mean_cosine = 0.0f;
    float max_extinction = 0.0f;

    bool emits() const { return !source.empty() || !emission.empty(); }
    bool scatters() const;  // some extinction has an albedo above zero
    Rgb albedo_at(std::size_t node) const { return albedo_nodes.empty() ? albedo : albedo_nodes[node]; }

    vec3 local_of_node(const ivec3& node) const { return local_from_index * vec3(node - reference_node); }
    dvec3 world_of_local(const vec3& p) const;
    vec3 local_of_world(const dvec3& p) const;
    std::uint64_t bytes() const;
};

// One volume of a frame. Keeps references.
struct MediumPart {
    const MediumGrids& grids;
    const MediumSettings& settings;
    bool half_voxel_shift = false;
};

// Builds the medium of one frame: the sum of all parts' coefficients, at least one of them, with the first one's phase
// function. Grids that are present but empty, or cannot contribute, are reported through `progress`; negative density
// and emission count as zero. Throws Error BadData without any grid, Temporary where lattices are too different.
Medium build_medium(std::span<const MediumPart> parts, Progress& progress);
Medium build_medium(const MediumGrids& grids, const MediumSettings& settings, bool half_voxel_shift,
                    Progress& progress);

}  // namespace brisance
