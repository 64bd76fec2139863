// HDR-FLIP: FLIP at all exposures at which the reference is visible. Each pixel keeps its largest error.
#pragma once

#include <vector>

#include "metrics/flip.h"
#include "metrics/picture.h"

namespace brisance {

// Evenly spaced, both ends included [stops].
struct Exposures {
    double start = 0.0;
    double stop = 0.0;
    int count = 2;
    double at(int index) const { return start + (stop - start) * index / (count - 1); }
};

// From the exposure that shows the largest luminance of the reference near white to the one that shows its median so.
// A reference twice as bright is exposed one stop less. For a black reference both are 0.
Exposures hdr_flip_exposures(const Picture& reference);

struct HdrFlip {
    Exposures exposures;
    Plane errors;                      // in [0, 1]
    std::vector<int> worst_exposures;  // per pixel, index of the exposure with the largest error
    double mean = 0.0;
};

// Both in linear Rec. 709 of any unit. NaN and negative values are shown black. Throws Error as flip_errors.
HdrFlip hdr_flip(const Picture& image, const Picture& reference, double pixels_per_degree = kPixelsPerDegree);

}  // namespace brisance
