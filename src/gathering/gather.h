// Gathers the light that arrives at points of the medium from all levels of a lighting grid hierarchy.
//
//   L(x) = sum_l sum_i I_{l,i} T(p_{l,i}, x) B_l(d) / d^2,   d = |x - p_{l,i}|                     [1]
//   (lighting_grid.h)
// with r_l = alpha h_l and blends B_l that sum to one over levels at every distance. Level 0 fades out over
// [r_0, 2 r_0]. Level l fades in over [r_l / 2, r_l] and out over [r_l, 2 r_l]. The top level never fades out.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "gathering/settings.h"
#include "lighting_grid/lighting_grid.h"
#include "medium/lattice/extinction_pyramid.h"
#include "near_field/near_field.h"
#include "receivers/receivers.h"
#include "shadows/large_vector.h"

namespace brisance {

// What one level cost.
struct LevelCost {
    int level = 0;
    std::size_t lights = 0;
    int resolution = 0;  // of its shadow maps; 0: no maps
    int distances = 0;
    std::uint64_t map_bytes = 0;   // of all its maps; fewer are held at once
    std::uint64_t held_bytes = 0;  // at once
    double map_seconds = 0.0;
    double gather_seconds = 0.0;
    std::uint64_t evaluations = 0;  // light and receiver pairs
};

// Shadow maps kept for a second gather from the same grid, whose positions and medium must not have changed.
struct ShadowMapCache {
    struct Level {
        LargeVector<std::uint16_t> maps;    // empty until made
        std::vector<std::uint32_t> map_of;  // on demand: of each light, its number among the maps (far_kernels.h)
        LargeVector<std::uint16_t> ends;    // of each map, where receivers beyond the medium have asked for them
    };
    std::vector<Level> levels;
    // Makes maps only of lights that may reach some receiver. This pays for few receivers among many lights and changes
    // no bit of the result.
    bool on_demand = false;
    // Such maps beside surfaces, of levels that need none in the open (separations.h); null until made.
    std::unique_ptr<ShadowMapCache> beside_surfaces = nullptr;

    std::uint64_t bytes() const;
};

// Lights of all levels in one medium.
struct LightField {
    const ExtinctionPyramid* pyramid;       // of the medium whose nodes carry the lights
    const std::vector<Rgb>* intensity;      // level 0, per node [W/sr]
    const std::vector<float>* directional;  // level 0, 24 per node, or null
    const LightingGrid* grid;               // levels above
    const std::vector<float>* weight;       // per node: weight of the grid's centres
    float alpha;
    LightingSettings settings;
    ShadowMapCache* cache = nullptr;       // used by levels that fit the memory limit as a whole
    const Occluders* occluders = nullptr;  // surfaces between lights and receivers
    // For receivers outside of the medium: per node, how likely its light is to leave the medium. Null: receivers are
    // inside.
    const std::vector<float>* escape = nullptr;
    int bottom = 0;  // the finest level: does not fade in, its lights are balls, and discs beside surfaces
};

// The nodes that need light, and the point toward which they scatter it.
struct LatticeRequest {
    const std::vector<std::uint8_t>* needed;  // per node
    std::optional<vec3> eye;                  // local [m]; none: no `scattered`
    bool moments = false;
    float mean_cosine = 0.0f;
    bool interpolates_far_light = true;  // between fewer nodes (node_receivers.h)
    int least_coarsening = 0;            // then at no more than every 2^n-th node
    // Of the light above the near field that all nodes would gather, what they gather themselves, in [0, 1]. The rest
    // is interpolated from every second node (light_between.h).
    float own_share = 1.0f;
};

// Gathers at the nodes of the medium: the near field exactly, the first levels above by separations (separations.h),
// the others with precomputed shadows. There is a near field where level 0 are the lattice's own nodes. Else field.grid
// holds all levels from field.bottom on: lights outside of the lattice (point_grid.h) and lamps (light_clusters.h),
// where field.intensity and field.directional are null, or lights that begin at a coarser level. The result is planar
// over nodes. Nodes that were not requested hold part of the sum and must not be used.
Gathered gather_at_nodes(const LightField& field, const LatticeRequest& request, std::vector<LevelCost>& costs,
                         Progress& progress);

// The share with which a picture errs by no more than it may: all where every node is to be lit by itself, or shadows
// are no maps. Else none at the usual error of 0.02 and above, all of it at half of that and below. A narrow phase
// function shows light from one side, and the smoke there is not that around a node: from a mean cosine of 0.4 to 0.6,
// of either sign, the share rises to all as well.
float own_share_of(const LightingSettings& settings, float mean_cosine);

// Returns the lit nodes as a level of lights for gather_at_points. Its vertices are the nodes.
GridLevel bottom_level(const LightField& field);

// Gathers at any points (local [m]) given as receivers, in the medium or on surfaces. Surfaces stop no light here.
// Level 0 uses marched shadows and the kernels of balls and discs; `bottom` holds its lights, is made once, and is not
// evaluated where field.bottom is a coarser level. The result is planar over receivers.
Gathered gather_at_points(const LightField& field, const GridLevel& bottom, const Receivers& receivers,
                          float mean_cosine, std::vector<LevelCost>& costs, Progress& progress,
                          ReceiverKind kind = ReceiverKind::Medium, bool moments = false);

}  // namespace brisance
