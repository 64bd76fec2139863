// Receivers of light from the medium.
#pragma once

#include "tracking/segment.h"

namespace brisance {

// A ray of the camera through the medium, or a point of a surface.
struct LightReceiver {
    bool is_ray = true;
    Segment ray;  // the part that is mostly seen
    dvec3 point{0.0}, normal{0.0};
    static LightReceiver along(const Segment& seen) { return {true, seen, {}, {}}; }
    // A point of the medium on a ray along `direction` (unit). `length`: short against all distances to lights [m].
    static LightReceiver in_smoke(const dvec3& point, const dvec3& direction, double length) {
        return along({point, direction, length});
    }
    static LightReceiver at(const dvec3& point, const dvec3& normal) { return {false, {}, point, normal}; }
};

}  // namespace brisance
