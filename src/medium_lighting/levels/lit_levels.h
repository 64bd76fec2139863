// Coarser lattices of a medium on which light is gathered first, and what the picture shows of their nodes.
#pragma once

#include <memory>
#include <vector>

#include "medium/coarse_medium.h"

namespace brisance {

// The camera, as far as the resolution of the lighting depends on it.
struct LightingCamera {
    vec3 eye{0.0f};            // local [m]
    float pixel_angle = 0.0f;  // width of a pixel per metre of distance
};

// The lattice 2^level coarser than the medium's.
struct LitLevel {
    int level = 0;
    Medium medium;
    std::unique_ptr<ExtinctionPyramid> pyramid;  // of `medium`
    std::vector<std::uint8_t> needed;            // per node: whether finer nodes are interpolated from it
    // Per node: how much of a pixel's radiance a change of the source function there changes, transmittance to the
    // camera times opacity times the part of a pixel that a voxel covers, as far as the light is kept. In [0, 1].
    std::vector<float> importance;
    // Per node: transmittance to the camera times opacity times solid angle, to average over what is seen [sr].
    std::vector<float> visible;
    // Per node: source function of the medium's own emission, luminance [W/(m^2 sr)]; empty: none.
    std::vector<float> emitted;
};

// Levels 1 to `count`, fewer where the pyramid has fewer. `needed`: nodes of the medium where light is needed; `kept`:
// the part of it, in [0, 1], that no other light will replace there; empty: all.
std::vector<LitLevel> make_lit_levels(const ExtinctionPyramid& pyramid, const std::vector<std::uint8_t>& needed,
                                      const std::vector<float>& kept, const LightingCamera& camera, int count);

// Per node, 0 where it is not needed: the radiance along the line from the eye through the node to the far end of the
// medium, luminance [W/(m^2 sr)]. `scattered`: source function of scattered light per node, luminance.
std::vector<float> radiance_through_nodes(const LitLevel& level, const std::vector<float>& scattered, const vec3& eye);

}  // namespace brisance
