// A point of a surface that the medium lights.
#pragma once

#include <array>

#include "core/vec.h"

namespace brisance {

// The light that a white Lambert surface there would reflect if no surface stood in its way [W/(m^2 sr)]: of dense
// smoke, and of thin media apart from it, as surfaces may hide the one, however bright, and not the other.
struct SurfaceReceiver {
    vec3 local;   // [m]
    vec3 normal;  // unit
    std::array<Rgb, 2> fire{}, smoke{};
};

}  // namespace brisance
