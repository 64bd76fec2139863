// What places on surfaces mean to the camera: how many of its paths come by.
#pragma once

#include "virtual_lights/camera_candidates.h"

namespace brisance {

// Of `places`, each kept by its own random number, about `target`: as likely as the density of the camera's candidates
// around it is high, and never less than one in a hundred. All, where there are fewer.
//
// F. Simon, J. Hanika, C. Dachsbacher, Rich-VPLs for Improving the Versatility of Many-Light Methods, Computer Graphics
// Forum 34(2), 2015.
std::vector<LightCandidate> reject_unimportant(const std::vector<LightCandidate>& places,
                                               const std::vector<LightCandidate>& from_camera, std::size_t target,
                                               std::uint32_t seed);

}  // namespace brisance
