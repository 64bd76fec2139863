// Positions of rays within a pixel.
#pragma once

#include <vector>

#include "camera/settings.h"

namespace brisance {

struct PixelSample {
    double x, y;  // offset from the pixel's centre
    float weight;
};

// A grid of n * n samples rotated by atan(1 / n), the same in each pixel. No two samples share a row or a column, so
// that vertical and horizontal edges have n * n shades instead of n, and smooth areas have no noise. `per_axis`: along
// the side of a pixel; wider filters have more. Weights add up to 1.
std::vector<PixelSample> pixel_samples(const CameraSettings& camera, int per_axis);

}  // namespace brisance
