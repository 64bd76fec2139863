// Precomputed volumetric shadows: for every light of a hierarchy level a directional map of transmittance as a function
// of distance. After [1] section on precomputed shadows (lighting_grid.h), with these choices of ours:
//  - Octahedral maps with a wrapped border texel: bilinear in direction, linear in distance, continuous everywhere.
//  - Range-limited: level l is only asked between alpha h_l / 2 and 2 alpha h_l (the top level: to the far end of the
//    medium), so distances are sampled there alone.
//  - What is stored and interpolated is transmittance, in 16 bits: a light stands for many, and the mean of their
//    transmittances is what the receiver needs.
//  - A light outside of the medium stands for no voxels, and its rays die within the smoke's skin, each at a place of
//    its own. Transmittance interpolated there would be too much by a quarter: such maps have a sample for every voxel,
//    and are interpolated as optical depth.
//  - A light stands for a region, and near it the mean transmittance of that region is what counts, more than that of
//    its centre (exp is convex, and fire burns where the smoke is dense): up to the nearest distance asked for, each
//    texel averages several rays that start at voxels the light stands for, picked systematically in proportion to what
//    they give it, and converge there.
//  - For receivers outside of the medium, where a ray ends matters less than where it begins: rays from kParallelRays
//    such voxels stay parallel all along. Voxels from which light escapes are picked more often, and count for less: in
//    dense smoke few others would be among them.
//  - Such rays take four steps in one where the medium is even around them (homogeneous_bricks.h), if they are told
//  where:
//    through a room full of haze they are long.
//  - Rays see density averaged over a sixteenth of the light's spacing near the light, shrinking to single voxels at
//    the far end.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting_grid/footprint.h"
#include "lighting_grid/lighting_grid.h"
#include "medium/lattice/extinction_pyramid.h"

namespace brisance {

struct ShadowMapLayout {
    int resolution = 16;       // texels along one side, without border
    int distances = 8;         // samples along a texel's ray
    float near_distance = 0;   // of the first sample [m]
    float far_distance = 0;    // of the last [m]
    bool for_outside = false;  // receivers are outside of the medium
    float range = 1.0f;        // the transmittance that is stored as 65535
    bool geometric = false;    // to be interpolated as optical depth, where nothing is opaque

    int side() const { return resolution + 2; }
    // 16-bit values per light; one is spare, since samples are read in pairs.
    std::size_t stride() const { return std::size_t(side()) * side() * distances + 2; }
    std::size_t bytes_per_light() const { return stride() * 2; }
};

// The maps of the lights [first, first + count) of `level`, one after another in `maps` (transmittance over range times
// 65535). `weights`: of the voxels that a light stands for, per node of the medium's lattice. `escape`: where
// layout.for_outside, how likely light from a node is to leave the medium. `occluders`: surfaces that light does not
// pass, or null.
void build_shadow_maps(const ExtinctionPyramid& pyramid, const GridLevel& level, const NodeWeights& weights,
                       const NodeWeights* escape, const ShadowMapLayout& layout, std::size_t first, std::size_t count,
                       std::vector<std::uint16_t>& maps, const Occluders* occluders = nullptr);

// Those of the lights in `list`, from `maps` on.
void build_shadow_maps(const ExtinctionPyramid& pyramid, const GridLevel& level, const NodeWeights& weights,
                       const NodeWeights* escape, const ShadowMapLayout& layout, std::span<const std::uint32_t> list,
                       std::uint16_t* maps, const Occluders* occluders = nullptr);

}  // namespace brisance
