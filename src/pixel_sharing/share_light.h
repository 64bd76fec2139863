// What a sample found, as pixels share it.
#pragma once

#include <optional>

#include "camera_rays/picture.h"
#include "geometry/surface_point.h"
#include "pixel_sharing/shared_bounce.h"

namespace brisance {

struct LightToShare {
    Rgb colour{1.0f};   // of the lobes, positive where they reflect
    Rgb light{0.0f};    // radiance that they reflect [W/(m^2 sr)]
    float lobe = 1.0f;  // their width: 1 for a base
    // Of what the sampled ray met, the inverse distance; 0: nothing [1/m].
    std::optional<double> closeness = std::nullopt;
    SharedBounce::Aparts apart = {};
};

// Half the angle [rad] in which a glossy lobe reflects.
float width_of_gloss(float roughness);
// Of the light that the lobes other than the base reflect.
Rgb colour_of_gloss(const SurfaceMaterial& material);

// `arriving`: the camera's direction at the point. `pixel_angle` [rad].
SharedBounce::Sample share_light(const SurfaceSample& sample, const SurfacePoint& point, const dvec3& arriving,
                                 double pixel_angle, const LightToShare& of);

// What the pixel shows of a sample [W/(m^2 sr)].
CellSum shown_by_cell(const SharedBounce::Sample& sample);

}  // namespace brisance
