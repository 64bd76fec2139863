// What a frame will cost, forecast from counts and never from a clock: seconds of one core of an AMD EPYC with AVX-512.
#pragma once

#include <vector>

#include "camera/camera.h"
#include "forecast/plan.h"
#include "medium/medium.h"
#include "medium_lighting/levels/lighting_level.h"
#include "reference/path_tracer.h"
#include "scattering/lattice_level.h"
#include "shot/shot.h"

namespace brisance {

// What forecasts ask of a medium, in passes over all of its nodes. Keeps a reference.
struct CountedMedium {
    explicit CountedMedium(const Medium& medium);
    const Medium& medium;
    double lit_nodes = 0.0;      // at which light is gathered
    std::vector<float> changes;  // changes_in_bricks()
};

// How the shot's orders of scattering are solved.
ScatteringSettings orders_of(const Shot& shot);

// The lattice on which the orders of scattering are solved, about, as levels above that of the smoke's light.
LatticeChoice forecast_lattice(const Shot& shot, const Medium& medium, int smoke_level);

// A picture by the lighting grid: evaluations of lights at nodes, shadow maps, orders of scattering, and the camera's
// rays. With surfaces and lamps it is a guess, within a factor of three; of lamps in haze it is up to seven times too
// low.
double grid_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan, const CameraSettings& camera);
// Of these, all but the camera's.
double lighting_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan);
double lighting_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan, const LightingLevels& levels);
// The camera's.
double camera_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan, const CameraSettings& camera);

// Whether that is known for pictures of the plan: not with surfaces, lamps and methods other than the hierarchy's.
bool grid_is_forecast(const Plan& plan);
// Whether it is known within a factor of two to three: with surfaces and lamps, too.
bool grid_is_estimated(const Plan& plan);

// Set-up of the path tracer.
double tracer_seconds(const Medium& medium);

// The variance and the length of paths.
struct PathPilot {
    double square_error = 0.0;  // of a picture of one camera ray per pixel: the square of its relative standard error
    double segments = 0.0;      // of all paths that one camera ray begins
    double lit = 1.0;           // share of the pixels in which light was found
    double segment_seconds = 0.0;
    double ray_seconds() const;      // of a camera ray with its paths
    double lit_ray_seconds() const;  // where there is light
};

// Traces so many pixels, spread evenly over the picture.
PathPilot trace_pilot(const PathTracer& tracer, const Camera& camera, std::size_t pixels);
double pilot_seconds(const PathPilot& pilot, std::size_t pixels);

}  // namespace brisance
