// Lights of even haze: what thin smoke far from dense smoke scatters.
//
// It is most of the nodes and little of the light, and changes slowly from one node to the next. Its lights therefore
// begin at a coarser level of the hierarchy, of which every light is a ball of its own spacing and asks its shadow map
// from close by on, and are spared the care that dense smoke's skin needs (exterior_hierarchy.h): a light's rays start
// at its centre, and the coarsest level is as coarse as haze bears. In a room full of haze they are a sixth as many,
// each with an eighth of the rays.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scattering/multiple_scattering.h"

namespace brisance {

// Of even haze's finest lights: bricks ask at points as far apart (thin_smoke.h).
constexpr int kFinestHazeLights = 2;

struct ThinMediumLights {
    HierarchyLights lights;
    LightField field;
    ShadowMapCache maps{{}, true};
};

// Takes the light of `bricks` out of `from`, which becomes a hierarchy of the rest. Null where they send none, or where
// they are too dense for it; then `from` stays as it is.
std::unique_ptr<ThinMediumLights> take_thin_medium_lights(const Medium& medium,
                                                          const std::vector<std::uint32_t>& bricks,
                                                          HierarchyLights& from);

// What was taken shines again in `light`.
void give_back(const ThinMediumLights& taken, const std::vector<std::uint32_t>& bricks, ScatteredLight& light);

}  // namespace brisance
