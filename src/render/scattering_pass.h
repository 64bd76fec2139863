// Virtual lights in the smoke as owners of MM and SM, ray lights or point lights: made for what the camera sees, asked
// by its rays, and what they leave to the lighting grid. MA goes by the camera's rays beside them.
//
// A pass draws the whole picture anew, with lights and random numbers of its own, and its lights are gone before those
// of the next are made: memory is that of one pass, time grows with their number, and all that is drawn with random
// numbers gains from it.
#pragma once

#include <functional>

#include "camera/camera.h"
#include "camera_rays/integrate.h"
#include "light_selection/in_scattering.h"
#include "render/plan.h"
#include "shot/shot.h"
#include "statistics/statistics.h"
#include "transport/direct_light.h"

namespace brisance {

// Throws Error Usage for what they do not work with.
void check_scattered_lights(const Shot& shot, const Plan& plan);

// A picture by the lights of a pass, from 0.
using DrawPass = std::function<Image(const InScattering& lights, int pass)>;

int passes_of(const Shot& shot, const Plan& plan);

// The mean of all passes, by lights of the kind that the plan names; `seconds`: spent on making them.
Image mean_of_passes(const Shot& shot, const Plan& plan, const DirectLight& scene, const Camera& camera,
                     const DrawPass& draw, double& seconds, Statistics& statistics, Progress& progress);

// MM by the lights, or null, and MA where the plan has it by rays; empty where there is neither. Keeps references to
// lights and scene.
LightRays light_rays_by(const InScattering* lights, const DirectLight* scene, const Plan& plan);

// What is left to the lighting grid, and how many scatterings it should think that it follows.
Plan without_scattered_lights(Plan plan);
int bounces_beside_scattered_lights(const Plan& plan);

}  // namespace brisance
