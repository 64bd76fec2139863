// Settings for gathering the fire's light and scattered light at points of the medium.
#pragma once

#include <cstdint>

namespace brisance {

enum class ShadowMethod {
    Maps,   // precomputed directional maps of transmittance
    Exact,  // numerical transmittance per light and point: slow, the check
    None    // no extinction between light and point: for studying the hierarchy alone
};

struct LightingSettings {
    // Relative error that shadow maps may add to the picture. Their resolution follows from it where it is not given.
    float error = 0.02f;
    // Relative error that light on voxels wider than the medium's own may add to the picture before it has scattered;
    // that of light of the smoke goes in proportion. Below 0: half of `error`.
    float lattice_error = -1.0f;
    // Relative error of the light that the picture shows up to which nodes are interpolated from coarser ones. 0: none
    // are, every node is lit by itself. Below 0: up to a quarter of `error`, where voxels twice as wide would serve
    // (medium_lighting/levels/lighting_level.h).
    float interpolation = -1.0f;
    float alpha = 2.0f;      // blending radius of level l is alpha * spacing of level l; at least 1
    int lattice_level = -1;  // light is gathered on voxels 2^level wide; -1: from `error`
    // The same for light that smoke scatters on, on no finer ones; -1: as the above if that is stated, or from `error`.
    int smoke_lattice_level = -1;
    int clusters = 0;  // lamps in the place of the fire's lights (light_clusters.h), a baseline; 0: none
    int levels = 0;    // hierarchy levels above the voxels; 0: from the volume's extent
    ShadowMethod shadows = ShadowMethod::Maps;
    int shadow_resolution = 0;  // texels along one side of the finest lights' octahedral maps; 0: from the error
    int shadow_distances = 0;   // transmittance samples along a texel's ray, levels below the top; 0: from the error
    std::uint64_t memory_limit_bytes = std::uint64_t{2} << 30;  // for shadow maps; resolution is lowered to respect it
    bool energy_balance = true;  // scale each bounce so that emitted = collided + escaped
};

}  // namespace brisance
