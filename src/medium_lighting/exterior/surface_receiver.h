// A point of a surface that the medium lights.
#pragma once

#include <array>

#include "core/vec.h"

namespace brisance {

// Light that a white Lambert surface there would reflect without occlusion by other surfaces [W/(m^2 sr)]. Dense smoke
// and thin media are separate, as surfaces may hide one of them, however bright, and not the other.
struct SurfaceReceiver {
    vec3 local;   // [m]
    vec3 normal;  // unit
    std::array<Rgb, 2> fire{}, smoke{};
};

}  // namespace brisance
