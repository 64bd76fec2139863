// What a sample found, as pixels share it.
#pragma once

#include "camera_rays/picture.h"
#include "geometry/surface_point.h"
#include "surface_lighting/shared_bounce.h"

namespace brisance {

struct LightToShare {
    Rgb colour;       // of the lobes, positive where they reflect
    Rgb light;        // radiance that they reflect [W/(m^2 sr)]
    Rgb residual;     // a part of it, told apart
    float lobe;       // their width: 1 for a base
    double distance;  // of the surface that the sampled ray met; infinite: none [m]
};

// Half the angle [rad] in which a glossy lobe reflects.
float width_of_gloss(float roughness);
// Of the light that the lobes other than the base reflect.
Rgb colour_of_gloss(const SurfaceMaterial& material);

// `arriving`: the camera's direction at the point. `pixel_angle` [rad].
SharedBounce::Sample share_light(const SurfaceSample& sample, const SurfacePoint& point, const dvec3& arriving,
                                 double pixel_angle, const LightToShare& of);

}  // namespace brisance
