// One image, or the step from one frame to the next, against its reference, by every measure.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "metrics/differences.h"
#include "metrics/hdr_flip.h"
#include "metrics/picture.h"

namespace brisance {

// One picture, or two independent halves whose mean is the reference.
struct Reference {
    Picture first;
    std::optional<Picture> second;
};

// Pixels with a channel that is NaN or infinite. A pixel that is so in any of the pictures is left out of the sums of
// all measures, and is wholly different (1) to FLIP, so that it is never taken for a good one.
struct NotFinite {
    std::size_t image = 0;
    std::size_t reference = 0;  // in either half
};

struct Comparison {
    NotFinite not_finite;
    Differences differences;                  // from the reference, or the mean of its halves
    std::optional<HalvesDifferences> halves;  // with two halves
    HdrFlip flip;                             // against the same as `differences`
};

// Pictures of one size. Throws Error as flip_errors.
Comparison compare(const Picture& image, const Reference& reference, double pixels_per_degree = kPixelsPerDegree);

// A frame and what it should have been.
struct Judged {
    Picture image;
    Reference reference;
};

// How far the image's change from one frame to the next is from the reference's: flicker that a still does not show.
struct TemporalError {
    NotFinite not_finite;                     // in either frame
    double error = 0.0;                       // ||(I' - I) - (R' - R)|| / ||R' - R||; infinite where R stands still
    std::optional<HalvesDifferences> halves;  // the same of the changes, with two halves
};

// All of one size and with as many halves. Throws Error BadData when they are not.
TemporalError compare_changes(const Judged& frame, const Judged& next);

}  // namespace brisance
