// Few lights begun at random among deposits and moved apart step by step, as Rich-VPLs are placed:
//
// F. Simon, J. Hanika, C. Dachsbacher, Rich-VPLs for Improving the Versatility of Many-Light Methods, Computer Graphics
// Forum 34(2), 2015.
//
// In every step a light at x moves away from the K lights x_k next to it, at the distances d_1 <= ... <= d_K, by
//
//     (3/2) (1/K) sum over k of (x - x_k) (d_K / d_k - 1)
//
// and comes to rest at the deposit nearest to where that leads, so that it stays on surfaces and where deposits are.
#pragma once

#include "virtual_lights/placement/thinning.h"

namespace brisance {

// At most settings.count positions, with the distance that each would keep in closest packing. No two lights share a
// deposit. Departs from the source: K and the number of steps are our own.
Survivors thin_by_relaxation(const std::vector<vec3>& positions, const VirtualLightSettings& settings);

}  // namespace brisance
