// FLIP: the difference that an observer perceives when flipping between two pictures on a display.
#pragma once

#include "metrics/picture.h"

namespace brisance {

// Of a display 0.7 m wide with 3840 pixels, seen from 0.7 m: the published default.
constexpr double kPixelsPerDegree = 67.0;

// Per pixel in [0, 1]. Both pictures are what a display emits, linear Rec. 709 in [0, 1]; what lies outside is clipped.
// Symmetric: the pictures may be swapped. Throws Error BadData when they differ in size, Usage when pixels_per_degree
// is not in [1, 1000].
Plane flip_errors(const Picture& image, const Picture& reference, double pixels_per_degree = kPixelsPerDegree);

double mean_of(const Plane& plane);

}  // namespace brisance
