// --seconds where surfaces or lamps are: how many samples a pixel may have.
//
// What a pixel of a set costs depends on what it shows, and counts do not tell it. So the lights are built first, and
// small pictures by them are timed. What is prepared once for a picture counts for more there, so that times of large
// ones are overrated rather than underrated.
#pragma once

#include "camera/settings.h"
#include "core/progress.h"
#include "forecast/plan.h"
#include "render/draw.h"
#include "render/many_lights.h"
#include "statistics/statistics.h"

namespace brisance {

// Whether the samples of a still picture can be chosen so: they are left open, and lights are placed once.
bool samples_follow_time(const Shot& shot, const Plan& plan, const CameraSettings& camera);

// The camera with the most samples that fit into `seconds` of wall time. A notice says how many; a warning says that
// even one does not fit.
CameraSettings camera_for_time(const DrawInput& input, const ManyLights& lights, double seconds, Statistics& statistics,
                               Progress& progress);

}  // namespace brisance
