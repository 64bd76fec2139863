// Pictures by a scattering method: its estimator of MM and SM is made for what the camera sees, and evaluated on the
// camera's rays.
//
// A pass draws the whole picture anew, with random numbers of its own, and its lights are gone before those of the next
// are made: memory is that of one pass, time grows with their number, and all that is drawn with random numbers gains
// from it.
#pragma once

#include <functional>

#include "camera/camera.h"
#include "camera_rays/picture.h"
#include "scattering_methods/methods.h"
#include "statistics/statistics.h"
#include "tracking/ray_medium.h"
#include "transport/direct_light.h"

namespace brisance {

// A picture by the estimator of a pass, from 0.
using DrawPass = std::function<Image(const InScattering& estimator, int pass)>;

// The mean of all passes. `bounces`: the most scatterings of a path, -1: all; `seconds`: spent on making estimators.
Image mean_of_passes(const ScatteringMethod& method, const ScatteringMethodSettings& settings, int bounces,
                     const DirectLight& scene, const Camera& camera, const DrawPass& draw, double& seconds,
                     Statistics& statistics, Progress& progress);

// Adds light that many single lights send to the medium on a ray, `seen`.
using ManyLightsOnRay = std::function<void(const RayMedium& seen, const PixelRay& ray, LightOnRay& light)>;

// MM by the estimator, or null, the share `emitters` of MA, and what many lights add, or empty; empty where there is
// nothing of that. `field` guides MA. Keeps references to all but `many_lights`.
LightRays light_rays_by(const InScattering* estimator, const DirectLight* scene, const SourceField& field,
                        float emitters, const ManyLightsOnRay& many_lights = {});

}  // namespace brisance
