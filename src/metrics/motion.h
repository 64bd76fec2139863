// Where the points that a frame's pixels show were seen in the frame before.
#pragma once

#include <vector>

#include "metrics/picture.h"

namespace brisance {

// Positions in the picture before, in pixels: (0, 0) is the outer corner of the top left pixel, y points down. NaN
// where the point was not seen: outside of that picture, behind its camera, or hidden by something nearer.
struct Motion {
    int width = 0;
    int height = 0;
    std::vector<glm::dvec2> before;  // rows from the top
};

// A frame as its file describes it: what each pixel shows lies at `depth` along the view axis [m], and
// `ndc_from_world` is the EXR's worldToNDC: x to the right and y down in [0, 1] after division by w, which is the
// depth.
struct SeenFrame {
    Plane depth;
    dmat4 ndc_from_world{1.0};
};

// Two depths agree if they differ by less than this share of the farther one.
constexpr double kSameDepth = 0.1;

// The movement that the cameras alone cause: points at the depths of `frame` stand still in the world. Movement of what
// is seen, such as smoke, is not in it. Throws Error BadData for pictures of different sizes and for a matrix that
// cannot be inverted.
Motion camera_motion(const SeenFrame& frame, const SeenFrame& before);

// From two channels: how far to go from a pixel to where its point was in the frame before [pixels], x to the right and
// y down.
Motion motion_of_vectors(const Plane& x, const Plane& y);

// Bilinear. `usable` as `picture`, empty for all. False where a pixel of the four is not usable or outside.
bool sample_before(const Picture& picture, const std::vector<bool>& usable, const glm::dvec2& at, Rgb& colour);

}  // namespace brisance
