// Virtual lights of surfaces as lights of a medium, from which the cell MS gathers.
#pragma once

#include <array>

#include "lighting_grid/point_grid.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

// The lights, split by the side of a fixed, oblique plane that their normals point to. The two faces of a wall have
// opposite normals, so that no coarse light represents both: such a light would lie in the wall and shine through it.
using PointsOfSides = std::array<PointLights, 2>;

// Each shines by Lambert's cosine about its normal; where several of curved surfaces are one, in spherical harmonics of
// degree 2 (6 % too bright along the normal, less than 2 % wrong on average over the hemisphere). Glossy profiles count
// by their power alone. `share`: of their light, in (0, 1]. `spacing`: of the medium's voxels [m]; lights are above
// their surfaces as its occluders need (surface_occluders.h).
PointsOfSides points_of_virtual_lights(const VirtualLights& lights, float share, float spacing);

}  // namespace brisance
