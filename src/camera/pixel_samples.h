// Positions of rays within a pixel.
#pragma once

#include <vector>

#include "camera/settings.h"
#include "core/vec.h"

namespace brisance {

struct PixelSample {
    double x, y;  // offset from the pixel's centre
    float weight;
};

// A grid of n * n samples rotated by atan(1 / n), the same in each pixel. No two samples share a row or a column, so
// that vertical and horizontal edges have n * n shades instead of n, and smooth areas have no noise. `per_axis`: along
// the side of a pixel; wider filters have more. Weights add up to 1. `shift`: moves all samples alike, in parts of
// their spacing; what leaves the filter on one side enters it on the other.
std::vector<PixelSample> pixel_samples(const CameraSettings& camera, int per_axis,
                                       const glm::dvec2& shift = glm::dvec2(0.0));

}  // namespace brisance
