// Vector types: GLM under the project's names, configured in one place.
#pragma once

#include <glm/glm.hpp>

namespace brisance {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::ivec3;
using glm::mat3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

// Linear Rec. 709 triple: radiance [W/(m^2 sr)], intensity [W/sr], albedo [1], as the name beside it says.
using Rgb = glm::vec3;

// Rec. 709 luminance weights.
inline float luminance(const Rgb& c) {
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

}  // namespace brisance
