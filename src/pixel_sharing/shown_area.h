// How much of a surface a pixel shows.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/surface_point.h"

namespace brisance {

// The cosine below which the area that a pixel shows counts as if it were this.
inline constexpr double kGrazing = 0.02;

// The area [m^2] of the surface that a pixel shows, if its width is `pixel_size` there [m].
inline float shown_area(const SurfacePoint& point, const dvec3& arriving, double pixel_size) {
    const double facing = std::abs(glm::dot(point.geometric_normal, arriving));
    return float(pixel_size * pixel_size / std::max(facing, kGrazing));
}

}  // namespace brisance
