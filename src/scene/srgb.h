// sRGB's curve.
#pragma once

#include <cmath>

namespace brisance {

inline float linear_from_srgb(float s) {
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

}  // namespace brisance
