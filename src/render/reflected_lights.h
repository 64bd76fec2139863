// Virtual lights of surfaces as the lights of a medium: what the cell MS asks.
#pragma once

#include <array>

#include "lights/point_grid.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

// Lights of the two sides of anything thin: coarse lights that stand for both would stand in the wall between, and
// shine through it. All normals that a plane in no common direction leaves on one side of it.
using LightsOfSides = std::array<PointLights, 2>;

// Each shines by Lambert's cosine about its normal, in spherical harmonics of degree 2 (6 % too bright along the
// normal, less than 2 % wrong on average over the hemisphere). Glossy profiles count by their power alone.
LightsOfSides reflected_lights(const VirtualLights& lights);

}  // namespace brisance
