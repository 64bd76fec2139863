// Occlusion by surfaces in the medium, applied to the shadow maps of a light.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "medium/lattice/occluders.h"
#include "shadows/shadow_maps.h"

namespace brisance {

// The part of a light's data that its maps depend on.
struct MappedLight {
    vec3 centre;                  // local [m]
    std::span<const vec3> parts;  // positions it represents; empty: the centre, and surfaces close to it do not hide it
    float start = 0.0f;           // distance from the centre at which the map's distances begin [m]
};

// Clears what lies behind surfaces in one map without border, as march_shadow_rays writes it. Up to
// layout.near_distance visibility is that from kParts of the light's parts, from there on along the texel's direction.
void cut_at_surfaces(const Occluders& occluders, const MappedLight& light, const ShadowMapLayout& layout,
                     std::span<std::uint16_t> interior);

}  // namespace brisance
