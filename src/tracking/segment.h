// A piece of a line.
#pragma once

#include "core/vec.h"

namespace brisance {

// `start` [m], `direction` unit, `length` [m].
struct Segment {
    dvec3 start{0.0};
    dvec3 direction{0.0, 0.0, 1.0};
    double length = 0.0;
    dvec3 at(double t) const { return start + direction * t; }
};

}  // namespace brisance
