// Ray lights as owners of MM and SM: made for what the camera sees, asked by its rays, and what they leave to the
// lighting grid.
#pragma once

#include <memory>

#include "ray_lights/ray_lights.h"
#include "render/camera.h"
#include "render/integrate.h"
#include "render/plan.h"
#include "render/statistics.h"
#include "shot/shot.h"

namespace brisance {

// Throws Error Usage for what ray lights do not work with.
void check_ray_lights(const Shot& shot);

std::unique_ptr<RayLights> trace_ray_lights_of(const Shot& shot, const DirectLight& scene, const Camera& camera,
                                               Statistics& statistics, Progress& progress);

// Keeps references to both.
LightRays light_rays_by(const RayLights& lights, const TrackingField& field);

// What is left to the lighting grid, and how many scatterings it should think that it follows.
Plan without_ray_lights(Plan plan);
int bounces_beside_ray_lights(const Plan& plan);

}  // namespace brisance
