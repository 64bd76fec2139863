// The frame that BSDFs are written in: z along the normal, which points to the outside of closed surfaces.
#pragma once

#include <cmath>

#include "core/vec.h"

namespace brisance {

struct ShadingFrame {
    dvec3 tangent{1.0, 0.0, 0.0}, bitangent{0.0, 1.0, 0.0}, normal{0.0, 0.0, 1.0};  // orthonormal

    dvec3 local_from_world(const dvec3& v) const {
        return {glm::dot(v, tangent), glm::dot(v, bitangent), glm::dot(v, normal)};
    }
    dvec3 world_from_local(const dvec3& v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
};

// Any frame around a unit normal. Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
inline ShadingFrame frame_around(const dvec3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z), b = n.x * n.y * a;
    return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

}  // namespace brisance
