// What surfaces in the medium take from the shadow maps of a light.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "medium/lattice/occluders.h"
#include "shadows/shadow_maps.h"

namespace brisance {

// A light as its maps know it.
struct MappedLight {
    vec3 centre;                  // local [m]
    std::span<const vec3> parts;  // places it stands for; none: it is where it is, and what lies close to it is its own
};

// Clears, of the texels of one map without border (as march_shadow_rays writes it), what lies behind surfaces: up to
// layout.near_distance as seen from kParts of the light's parts, from there on along the texel's direction.
void cut_at_surfaces(const Occluders& occluders, const MappedLight& light, const ShadowMapLayout& layout,
                     std::span<std::uint16_t> interior);

}  // namespace brisance
