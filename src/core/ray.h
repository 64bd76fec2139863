#pragma once

#include "core/vec.h"

namespace brisance {

struct Ray {
    dvec3 origin{0.0};     // local [m]
    dvec3 direction{0.0};  // unit
};

}  // namespace brisance
