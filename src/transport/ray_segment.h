// A ray up to the first surface.
#pragma once

#include <optional>

#include "geometry/surface_point.h"
#include "tracking/line_tracker.h"

namespace brisance {

struct RaySegment {
    Ray ray;
    double end = kNoEnd;                // distance of the surface [m]
    std::optional<SurfaceHit> hit;      // none: the ray leaves the scene
    std::optional<SurfacePoint> point;  // the surface point; set whenever `hit` is
};

}  // namespace brisance
