// Directions of a hemisphere around z as points in a square: texels of equal size are equal solid angles.
//
// The square becomes a disc (Shirley and Chiu, A Low Distortion Map Between Disk and Square, JGT 2(3), 1997) and the
// disc a hemisphere (Lambert's azimuthal projection); together the octahedral map that keeps areas (Clarberg, Fast
// Equal-Area Mapping of the (Hemi)Sphere using SIMD, JGT 13(3), 2008) but for a turn by 45 degrees.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/vec.h"

namespace brisance {

// Unit, z >= 0, of u, v in [0, 1].
inline dvec3 hemisphere_of_square(double u, double v) {
    const double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0;
    double r = 0.0, angle = 0.0;
    if (std::abs(a) > std::abs(b)) {
        r = a;
        angle = std::numbers::pi / 4.0 * (b / a);
    } else {
        r = b;
        angle = b == 0.0 ? 0.0 : std::numbers::pi / 2.0 - std::numbers::pi / 4.0 * (a / b);
    }
    const double across = r * std::sqrt(2.0 - r * r);
    return {across * std::cos(angle), across * std::sin(angle), 1.0 - r * r};
}

// Of a unit vector; what lies below the hemisphere counts as its edge.
inline glm::dvec2 square_of_hemisphere(const dvec3& d) {
    const double r = std::sqrt(std::clamp(1.0 - d.z, 0.0, 1.0));
    const double quarter = std::numbers::pi / 4.0;
    double angle = std::atan2(d.y, d.x);
    if (angle < -quarter)
        angle += 2.0 * std::numbers::pi;
    double a = 0.0, b = 0.0;
    if (angle < quarter) {
        a = r;
        b = angle * a / quarter;
    } else if (angle < 3.0 * quarter) {
        b = r;
        a = -(angle - 2.0 * quarter) * b / quarter;
    } else if (angle < 5.0 * quarter) {
        a = -r;
        b = (angle - 4.0 * quarter) * a / quarter;
    } else {
        b = -r;
        a = -(angle - 6.0 * quarter) * b / quarter;
    }
    return {std::clamp(0.5 * a + 0.5, 0.0, 1.0), std::clamp(0.5 * b + 0.5, 0.0, 1.0)};
}

// The texel, of side * side, that a direction falls into.
inline std::size_t texel_of(const dvec3& d, int side) {
    const glm::dvec2 p = square_of_hemisphere(d);
    const int x = std::min(static_cast<int>(p.x * side), side - 1),
              y = std::min(static_cast<int>(p.y * side), side - 1);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
}

}  // namespace brisance
