// How much of what the camera sees of a medium is a part of it.
#pragma once

#include <vector>

#include "optical_depths/point_depths.h"

namespace brisance {

// In [0, 1]: the sum over nodes of `part` times what is seen of the node, over the sum of what is seen of all. What is
// seen of a node is its scattering opacity, times transmittance to the camera, times the solid angle of its voxel:
// proportional to what the picture would show if light were the same everywhere. `eye`: of the camera, local [m].
float seen_share(const Medium& medium, const PointDepths& depths, const std::vector<float>& part, const vec3& eye);

}  // namespace brisance
