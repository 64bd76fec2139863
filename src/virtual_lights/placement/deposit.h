// What a placement leaves on surfaces: positions where virtual lights may lie.
#pragma once

#include "core/vec.h"
#include "geometry/surface_point.h"

namespace brisance {

struct Deposit {
    SurfaceHit hit;
    vec3 position;           // local [m]
    vec3 direction;          // unit, back along the path: toward the camera, or toward the source of light
    int scene_material = 0;  // of the surface
    Rgb power{0.0f};         // that arrives, for the surface's shading normal [W]; 0 where it is not known
};

}  // namespace brisance
