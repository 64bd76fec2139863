// Lights of homogeneous thin media: light scattered by thin smoke far from dense smoke.
//
// These bricks hold most of the nodes and little of the light, which changes slowly from one node to the next. Their
// lights therefore begin at a coarser level of the hierarchy, where every light is a ball of the size of its spacing
// and uses its shadow map at short distances, too. They do not need the treatment of dense smoke's skin
// (exterior_hierarchy.h): the shadow rays of a light start at its centre, and the coarsest level is as coarse as thin
// media allow. In a room full of haze there are a sixth as many lights, each with an eighth of the rays.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scattering/multiple_scattering.h"

namespace brisance {

// Level of the finest lights of homogeneous thin media; their bricks gather at points of the same spacing
// (thin_medium.h).
constexpr int kFinestThinLights = 2;

struct ThinMediumLights {
    std::vector<std::uint32_t> bricks;  // whose light it is
    HierarchyLights lights;
    LightField field;
    ShadowMapCache maps{{}, true};
};

// Moves the light of those of the `even` bricks that are thin enough out of `from`, which becomes the hierarchy of the
// remaining light. Returns null and leaves `from` unchanged if they send no light.
std::unique_ptr<ThinMediumLights> take_thin_medium_lights(const Medium& medium, const std::vector<std::uint32_t>& even,
                                                          HierarchyLights& from);

// Adds the light that was taken back to `light`.
void give_back(const ThinMediumLights& taken, ScatteredLight& light);

}  // namespace brisance
