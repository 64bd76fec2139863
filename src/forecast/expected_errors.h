// The error model of pictures by many lights: what their errors should be, before any sample says.
//
// Each cell's error is the root of a sum of squares. Shadow maps have a measured error that falls with their
// resolution (gathering/map_layouts.cpp). A voxel is the source and the receiver of light as a whole, which errs with
// the square of its optical depth, and the orders of scattering err with that of a voxel of the coarser lattice that
// solves them. What interpolation may add is as the shot allows, and what is left of the series is as the frame
// measured it. The coefficients are of the built-in explosion and of three volumes of smoke with optical depths of a
// voxel from 0.6 to 3. Of seven pictures of fire and smoke, in the air and on floors, certificates say up to 2.2 times
// what is expected of MV and MM, and 0.9 times at least: their logarithms differ by 0.3 (root mean square), which
// `spread` follows. Noise that surfaces keep is as the camera expects it. Other errors of light of surfaces, and of
// scattering methods with random samples, are not modelled: what is expected of them is little more than a guess.
#pragma once

#include <functional>

#include "certificate/believed_error.h"
#include "film/image.h"
#include "forecast/costs.h"
#include "forecast/plan.h"
#include "statistics/statistics.h"

namespace brisance {

// By reference.
struct ModelledFrame {
    const Shot& shot;
    const Medium& medium;
    const Plan& plan;
};

// Of a finished picture and of its cells, the picture first. A black picture has an expected error of 0. `change`: of
// what the model expects of a cell, where more is known, and of the noise on surfaces, which is no cell's; empty:
// nothing is.
std::vector<ExpectedError> expected_errors(const Image& image, const ModelledFrame& frame, const Statistics& statistics,
                                           const std::function<void(ExpectedError&)>& change = {});

// The shot of a frame that has been rendered, with the lattices of its light, and that on which its orders of
// scattering were solved: before that is known, grid_seconds() can only guess where the light is.
Shot as_solved(const Shot& shot, const Statistics& statistics);

// Of a picture that is not rendered yet.
ExpectedError expected_error(const ModelledFrame& frame);

}  // namespace brisance
