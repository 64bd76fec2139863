// The error that changes against the motion: what is seen to flicker. An error that merely travels with what is seen is
// none of it.
#pragma once

#include <optional>

#include "metrics/comparison.h"
#include "metrics/motion.h"

namespace brisance {

// Of e = I - R in one frame and e' = I' - R' in the next, over the pixels whose point was seen in the frame before.
struct Flicker {
    NotFinite not_finite;  // in either frame
    double seen = 0.0;     // share of the finite pixels whose point was seen in the frame before
    double error = 0.0;    // ||e' - warp(e)|| / ||R'||; infinite where R' is black and the error is not
    // With two halves A and B, as in HalvesDifferences: without the noise of the reference, and that noise alone.
    std::optional<HalvesDifferences> halves;
};

// `motion` leads from pixels of `next` back into `frame`. Between pixels e is interpolated linearly, which removes up
// to half of the noise of single pixels from warp(e). Throws Error BadData as compare_changes, and for a motion of
// another size.
Flicker measure_flicker(const FrameAndReference& frame, const FrameAndReference& next, const Motion& motion);

}  // namespace brisance
