// Which of a medium's lights are seen from outside: in dense smoke, those of its skin.
#pragma once

#include <vector>

#include "gathering/point_depths.h"
#include "lights/footprint.h"

namespace brisance {

// For every node with an intensity above zero the mean transmittance to the outside over PointDepths::kRays fixed
// directions, 0 for others: an importance, not an estimate.
NodeWeights escape_likelihood(const Medium& medium, const PointDepths& depths, const std::vector<Rgb>& intensity);

}  // namespace brisance
