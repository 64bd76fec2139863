// Moving positions and normals of meshes.
#pragma once

#include <cmath>

#include "core/vec.h"

namespace brisance {

// From a mesh's space to local space: in double until the scene's origin is taken off.
struct Affine {
    dmat3 linear{1.0};
    dvec3 offset{0.0};

    // The last row of `world_from_mesh` counts as 0 0 0 1.
    static Affine local(const dmat4& world_from_mesh, const dvec3& origin) {
        return {dmat3(world_from_mesh),
                dvec3(world_from_mesh[3].x, world_from_mesh[3].y, world_from_mesh[3].z) - origin};
    }
    vec3 position(const vec3& p) const { return vec3(linear * dvec3(p) + offset); }
    bool mirrors() const { return glm::determinant(linear) < 0.0; }
};

// Normals by the inverse transpose. Cofactors are that times the determinant, and exist where it is 0.
class NormalMap {
public:
    explicit NormalMap(const Affine& map) {
        const dmat3& m = map.linear;
        const double sign = map.mirrors() ? -1.0 : 1.0;
        cofactors_ = dmat3(sign * glm::cross(m[1], m[2]), sign * glm::cross(m[2], m[0]), sign * glm::cross(m[0], m[1]));
    }
    // Of unit length; 0 where there is no direction.
    vec3 normal(const vec3& n) const {
        const dvec3 turned = cofactors_ * dvec3(n);
        const double length = glm::length(turned);
        return length > 0.0 && std::isfinite(length) ? vec3(turned / length) : vec3(0.0f);
    }

private:
    dmat3 cofactors_{1.0};
};

}  // namespace brisance
