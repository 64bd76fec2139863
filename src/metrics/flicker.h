// The error that changes against the motion: what is seen to flicker. An error that merely travels with what is seen is
// none of it.
#pragma once

#include <optional>

#include "metrics/comparison.h"
#include "metrics/motion.h"

namespace brisance {

// Sums over pixels and channels that errors are made of. Those of several pairs of frames add up.
struct FlickerSums {
    double change = 0.0;           // of (e' - warp(e))^2, with e against the mean of the halves
    double cross = 0.0;            // of the product of the changes against either half
    double noise = 0.0;            // of the squared half difference of the two
    double reference = 0.0;        // of R'^2
    double reference_cross = 0.0;  // of the product of the halves
    std::size_t pixels = 0;        // whose point was seen in the frame before
    std::size_t finite = 0;        // of which these are a part

    void add(const FlickerSums& more);
};

// Of e = I - R in one frame and e' = I' - R' in the next, over the pixels whose point was seen in the frame before.
struct Flicker {
    NotFinite not_finite;  // in either frame
    double seen = 0.0;     // share of the finite pixels whose point was seen in the frame before
    double error = 0.0;    // ||e' - warp(e)|| / ||R'||; infinite where R' is black and the error is not
    // With two halves A and B, as in HalvesDifferences: without the noise of the reference, and that noise alone.
    std::optional<HalvesDifferences> halves;
    FlickerSums sums;
};

// From sums over one pair of frames, or over all pairs of a sequence: what is known of one pair may be less than the
// reference's noise. `not_finite` is left at 0.
Flicker flicker_of(const FlickerSums& sums, bool halves);

// `motion` leads from pixels of `next` back into `frame`. Between pixels e is interpolated linearly, which removes up
// to half of the noise of single pixels from warp(e). Throws Error BadData as compare_changes, and for a motion of
// another size.
Flicker measure_flicker(const FrameAndReference& frame, const FrameAndReference& next, const Motion& motion);

}  // namespace brisance
