// Where a pixel's rays go through it.
#pragma once

#include <vector>

#include "camera/settings.h"

namespace brisance {

struct PixelSample {
    double x, y;  // offset from the pixel's centre
    float weight;
};

// A grid turned by atan(1 / n), n * n samples, the same in each pixel: no two of them share a row or a column, so that
// upright and level edges have n * n shades and not n, and what is smooth has no noise. `per_axis`: along the side of a
// pixel; wider filters have more. Weights add up to 1.
std::vector<PixelSample> pixel_samples(const CameraSettings& camera, int per_axis);

}  // namespace brisance
