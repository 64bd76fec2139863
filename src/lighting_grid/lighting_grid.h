// Lighting grid hierarchy: lights splatted to the vertices of ever coarser lattices.
// [1] C. Yuksel and C. Yuksel, Lighting Grid Hierarchy for Self-illuminating Explosions, SIGGRAPH 2017.
//
// Level 0 is the medium's own nodes (voxel_lights.h). Level l >= 1 has vertices at every 2^l-th node. They are fixed in
// the world as long as the volume's transform is, whatever the bounds of a frame. Every level is made from level 0:
//   I_{l,i} = sum_j w_{l,i}(x_j) I_j                    [1] eq. 1, w the trilinear hat of vertex i
//   p_{l,i} = sum_j v_j x_j / sum_j v_j,  v_j = w Y_j   [1] eq. 2, Y luminance (or another positive weight)
// so each level carries the same total intensity and first moment. Trilinear splats nest, so the construction makes
// each level exactly from the moments about the vertices of the level below.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "medium/medium.h"

namespace brisance {

// A ball of fire and smoke that a light stands for: shadows begin at its surface (light_clusters.h).
struct LightBall {
    float radius;  // [m]
    float inside;  // transmittance to points of the ball, mean
    float escape;  // transmittance out of the ball, mean
};

// Lambert's cosine about a normal, by which a part of a light shines; the rest by harmonics (point_grid.h).
struct CosineLobe {
    vec3 normal;  // unit
    float share;  // in [0, 1]
};

struct GridLevel {
    int level = 0;
    float spacing = 0.0f;        // h_l [m]
    std::vector<ivec3> vertex;   // in vertices of this level, sorted by (x, y, z)
    std::vector<vec3> position;  // illumination centre, local [m]
    std::vector<Rgb> intensity;  // [W/sr]

    // Degrees 1 and 2 of a directional intensity, 24 per light ([3 * m + colour], sh.h); empty: isotropic.
    std::vector<float> directional;
    std::vector<CosineLobe> lobe;  // of each light; empty: harmonics alone

    // Luminance of what each light sends to receivers outside of dense smoke (thin_media/exterior_hierarchy.h); or
    // empty.
    std::vector<float> escaping;

    std::vector<LightBall> ball;  // of each light; empty: that of a voxel of the level

    // For lights outside of the medium: light i represents the positions part[first_part[i] ... first_part[i + 1]),
    // local [m]. Empty where lights represent voxels.
    std::vector<vec3> part;
    std::vector<std::uint32_t> first_part;

    BrickLattice lattice;             // of this level's vertices
    std::vector<std::uint32_t> node;  // of each light, in fields on `lattice`

    // Vertices with x, y fixed lie together: row (x, y) holds [row_begin[r], row_begin[r + 1]).
    ivec3 min_vertex{0};
    ivec3 vertex_extent{0};
    std::vector<std::uint32_t> row_begin;

    std::size_t size() const { return vertex.size(); }
    std::span<const vec3> parts_of(std::size_t light) const {
        return first_part.empty()
                   ? std::span<const vec3>()
                   : std::span(part).subspan(first_part[light], first_part[light + 1] - first_part[light]);
    }
    void index_rows();  // from `vertex`
    std::uint64_t bytes() const;
    // Appends the lights whose vertex lies in [low, high], in order.
    void find_in_box(const ivec3& low, const ivec3& high, std::vector<std::uint32_t>& found) const;
};

struct LightingGrid {
    std::vector<GridLevel> levels;  // levels[k].level = first_level + k
    std::uint64_t bytes() const;
};

// Builds levels 1 .. `levels` of the lights in `intensity` (per node of `lattice`). Where given, `weight` (per node,
// >= 0) replaces luminance in the centres, so that positions do not depend on the intensities; the scattering operator
// needs this.
LightingGrid build_lighting_grid(const Medium& medium, const std::vector<Rgb>& intensity,
                                 const std::vector<float>* weight, int levels);

// Replaces the intensities of all levels by those of other level-0 lights; positions and extents stay. The result is
// exact when every node lit now was among the lights that the grid was built from. `directional` (24 per node, or null)
// is replaced likewise.
void set_intensity(LightingGrid& grid, const BrickLattice& lattice, const std::vector<Rgb>& intensity,
                   const std::vector<float>* directional);

// The number of levels for which the top level has at most about five vertices along the longest side of the medium.
int automatic_levels(const Medium& medium);

}  // namespace brisance
