// The octahedral map takes unit directions to a square. Its areas are even enough for shadows, and it has no seams
// between faces.
// Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, JCGT 3(2), 2014.
#pragma once

#include <cmath>

#include "core/vec.h"

namespace brisance {

// The direction of a point of the square [-1, 1]^2.
inline vec3 octahedral_direction(float u, float v) {
    const float z = 1.0f - std::abs(u) - std::abs(v);
    const float x = z >= 0.0f ? u : (1.0f - std::abs(v)) * (u < 0.0f ? -1.0f : 1.0f);
    const float y = z >= 0.0f ? v : (1.0f - std::abs(u)) * (v < 0.0f ? -1.0f : 1.0f);
    return glm::normalize(vec3(x, y, z));
}

}  // namespace brisance
