// Which of a medium's lights are seen from outside: in dense smoke, those of its skin.
#pragma once

#include <vector>

#include "gathering/point_depths.h"
#include "lighting_grid/footprint.h"

namespace brisance {

// Over PointDepths::kRays fixed directions, from a place in the medium, local [m].
float mean_transmittance_outside(const Medium& medium, const PointDepths& depths, const vec3& from);

// For every node with an intensity above zero the mean transmittance to the outside over PointDepths::kRays fixed
// directions, 0 for others: an importance, not an estimate.
NodeWeights escape_likelihood(const Medium& medium, const PointDepths& depths, const std::vector<Rgb>& intensity);

// Where to ask for what escapes: luminance of the intensity, times the likelihood over its mean but for the share
// FootprintPicker::kLeastShare, which does not follow it. The sum is that of the luminances.
NodeWeights escape_density(const std::vector<Rgb>& intensity, const NodeWeights& likelihood);

}  // namespace brisance
