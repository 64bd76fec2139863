// The layers of output.layers.bound: SS in the parts that the bound of virtual point lights makes of it, and where the
// bound acts.
#pragma once

#include <string>

#include "core/progress.h"
#include "film/image.h"
#include "forecast/plan.h"
#include "shot/shot.h"
#include "statistics/statistics.h"
#include "surface_lighting/bound_account.h"

namespace brisance {

// Whether the frame has such layers.
bool has_bound_layers(const Shot& shot, const Plan& plan);

// Throws Error Usage where the shot's choices do not go with the layers. Says which of them are left out, and why.
void check_bound_layers(const Shot& shot, const Plan& plan, Progress& progress);

// Adds what one picture found as sums, so that means over pictures are right: SS_residual, and luminances for `bound`.
void add_bound_sums(Image& image, const Shot& shot, const BoundAccount& found);

// Makes SS_bounded, SS_residual and bound of the sums of the finished picture: SS_bounded + SS_residual is SS. Reports
// them with `costs`, the processor time that all pictures took.
void finish_bound_layers(Image& image, const BoundTally& costs, Statistics& statistics);

}  // namespace brisance
