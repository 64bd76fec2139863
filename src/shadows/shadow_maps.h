// Precomputed volumetric shadows: for every light of a hierarchy level, a directional map of transmittance as a
// function of distance. They follow the section of [1] on precomputed shadows (lighting_grid.h), with these choices of
// ours:
//  - Maps are octahedral with a wrapped border texel: bilinear in direction, linear in distance, continuous everywhere.
//  - Level l is only evaluated between alpha h_l / 2 and 2 alpha h_l (the top level: up to the far end of the medium),
//    so distances are sampled there alone.
//  - Maps store and interpolate transmittance, in 16 bits: a light represents many, and the receiver needs the mean of
//    their transmittances.
//  - A light outside of the medium represents no voxels, and each of its rays is extinguished at a different depth near
//    the smoke's boundary. Interpolated transmittance would be too large by a quarter there, so such maps have a sample
//    for every voxel and are interpolated as optical depth.
//  - A light represents a region. Near it the mean transmittance of that region counts more than that of its centre,
//    because exp is convex and fire burns where the smoke is dense. Up to the first stored distance, each texel
//    therefore averages several rays. They start at voxels of the region, picked systematically in proportion to their
//    contribution to the light, and converge at that distance.
//  - For receivers outside of the medium, where a ray ends matters less than where it begins: rays from several such
//    voxels stay parallel along their full length. Voxels from which light escapes are picked more often and weigh
//    less; in dense smoke few of them would be picked otherwise. The number of rays follows what the light sends
//    outside (ParallelRays below).
//  - Such rays take four steps in one inside homogeneous bricks (homogeneous_bricks.h), where these are given: rays
//    through a room full of thin smoke are long.
//  - Rays see density averaged over a sixteenth of the light's spacing near the light, shrinking to single voxels at
//    the far end.
//  - A light outside of the sphere around the medium has the part of a map that receivers in the medium read.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting_grid/footprint.h"
#include "lighting_grid/lighting_grid.h"
#include "medium/lattice/extinction_pyramid.h"
#include "shadows/large_vector.h"

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

// The layout of the last distance of maps alone.
inline ShadowMapLayout ends_of(ShadowMapLayout layout) {
    layout.distances = 1;
    return layout;
}

// The number of parallel rays for each texel of the maps of a level's lights. The variance of a sum of lights is least
// for a given number of rays where that number is in proportion to what each light sends: most lights on the skin of
// dense smoke send little. Without GridLevel::escaping, all have the same.
class ParallelRays {
public:
    static constexpr int kLeast = 2, kTypical = 16, kSame = 8;

    explicit ParallelRays(const GridLevel& level);
    int of(std::size_t light) const;

private:
    const std::vector<float>& escaping_;
    double typical_ = 0.0;  // of the light that brings the mean unit of power
};

// Builds the maps of the lights [first, first + count) of `level`, one after another in `maps` (transmittance over
// range times 65535). `weights` are those of the voxels that a light represents, per node of the medium's lattice.
// `escape` is needed where layout.for_outside is set: how likely light from a node is to leave the medium. `occluders`
// are surfaces that block light, or null.
void build_shadow_maps(const ExtinctionPyramid& pyramid, const GridLevel& level, const NodeWeights& weights,
                       const NodeWeights* escape, const ShadowMapLayout& layout, std::size_t first, std::size_t count,
                       LargeVector<std::uint16_t>& maps, const Occluders* occluders = nullptr);

// Builds the maps of the lights in `list`, one after another in `maps`.
void build_shadow_maps(const ExtinctionPyramid& pyramid, const GridLevel& level, const NodeWeights& weights,
                       const NodeWeights* escape, const ShadowMapLayout& layout, std::span<const std::uint32_t> list,
                       std::uint16_t* maps, const Occluders* occluders = nullptr);

}  // namespace brisance
