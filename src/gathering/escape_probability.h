// Finds which of a medium's lights are seen from outside. In dense smoke they are those near its boundary.
#pragma once

#include <vector>

#include "lighting_grid/footprint.h"
#include "optical_depths/point_depths.h"

namespace brisance {

// Mean transmittance from a point in the medium (local [m]) to the outside over PointDepths::kRays fixed directions.
float mean_transmittance_outside(const Medium& medium, const PointDepths& depths, const vec3& from);

// Returns mean_transmittance_outside() for every node with an intensity above zero, and 0 for all others. It is an
// importance, not an estimate. `known`, where given, remembers it from one call to the next for other intensities in
// the same medium; it is empty at first.
NodeWeights escape_likelihood(const Medium& medium, const PointDepths& depths, const std::vector<Rgb>& intensity,
                              NodeWeights* known = nullptr);

// Sampling density for escaping light: the luminance of the intensity times the likelihood over its mean. The share
// FootprintPicker::kLeastShare does not follow the likelihood. The densities sum to the sum of the luminances.
NodeWeights escape_density(const std::vector<Rgb>& intensity, const NodeWeights& likelihood);

}  // namespace brisance
