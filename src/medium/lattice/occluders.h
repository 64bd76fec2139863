// Surfaces that stand in a medium and occlude its light.
#pragma once

#include "core/vec.h"

namespace brisance {

// Nodes often lie in the plane of a surface: floors are at 0, and so are nodes. Rays from and to such nodes would meet
// it or not as rounding goes, and not both ways alike. All positions are therefore moved by the same small part of a
// voxel, in a direction that hardly any surface has: a node in a surface is on one side of it, above a floor whichever
// axis points up. It is far above single precision in volumes of thousands of voxels, and far below what a picture
// shows.
constexpr vec3 kBesidePlanes{0.0013f, 0.0017f, 0.0023f};  // of a voxel

class Occluders {
public:
    virtual ~Occluders() = default;

    // The distance from `from` along unit `direction` to the first surface, or `far` where none is nearer; local [m].
    virtual float first_hit(const vec3& from, const vec3& direction, float far) const = 0;
    // Whether there may be a surface within a ball; local [m].
    virtual bool any_within(const vec3& centre, float radius) const = 0;

    bool visible(const vec3& from, const vec3& to) const {
        const vec3 offset = to - from;
        const float distance = glm::length(offset);
        return !(distance > 0.0f) || first_hit(from, offset / distance, distance) >= distance;
    }
};

}  // namespace brisance
