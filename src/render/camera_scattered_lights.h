// Virtual lights in the smoke as owners of MM and SM, ray lights or point lights: made for what the camera sees, asked
// by its rays, and what they leave to the lighting grid.
#pragma once

#include <memory>

#include "ray_lights/lights_in_smoke.h"
#include "render/camera.h"
#include "render/integrate.h"
#include "render/plan.h"
#include "render/statistics.h"
#include "shot/shot.h"
#include "tracing/direct_light.h"

namespace brisance {

// Throws Error Usage for what they do not work with.
void check_scattered_lights(const Shot& shot);

// Of the kind that scattering.method names. Keeps a reference to the scene.
std::unique_ptr<LightsInSmoke> trace_scattered_lights(const Shot& shot, const DirectLight& scene, const Camera& camera,
                                                      Statistics& statistics, Progress& progress);

// Keeps references to both.
LightRays light_rays_by(const LightsInSmoke& lights, const TrackingField& field);

// What is left to the lighting grid, and how many scatterings it should think that it follows.
Plan without_scattered_lights(Plan plan);
int bounces_beside_scattered_lights(const Plan& plan);

}  // namespace brisance
