// Virtual lights of surfaces as the lights of a medium: what the cell MS asks.
#pragma once

#include "lights/point_grid.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

// Each shines by Lambert's cosine about its normal, in spherical harmonics of degree 2 (6 % too bright along the
// normal, less than 2 % wrong on average over the hemisphere). Glossy profiles count by their power alone.
PointLights reflected_lights(const VirtualLights& lights);

}  // namespace brisance
