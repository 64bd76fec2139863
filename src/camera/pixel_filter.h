// The weight of a ray in its pixel.
#pragma once

#include <cmath>

#include "camera/settings.h"

namespace brisance {

// Weight of a ray at an offset from the pixel's centre in filter widths, each within [-1/2, 1/2], with mean one over
// that square.
inline float filter_weight(PixelFilter filter, double x, double y) {
    if (filter == PixelFilter::Box)
        return 1.0f;
    // Standard deviation a quarter of the width; sqrt(2 pi) erf(sqrt 2) / 4 is the mean along one axis.
    constexpr double mean = 0.5981440;
    return static_cast<float>(std::exp(-8.0 * (x * x + y * y)) / (mean * mean));
}

}  // namespace brisance
