// Surfaces that stand in a medium and occlude its light.
#pragma once

#include "core/vec.h"

namespace brisance {

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
