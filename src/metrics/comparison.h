// Every measure of one image, or of the change from one frame to the next, against its reference.
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

// Pixels with a channel that is NaN or infinite. A pixel that is not finite in any of the pictures is left out of
// the sums of all measures. Its FLIP error is 1, so that it never counts as correct.
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

// A frame and its reference.
struct FrameAndReference {
    Picture image;
    Reference reference;
};

// The error of the image's change from one frame to the next: flicker that a still does not show.
struct TemporalError {
    NotFinite not_finite;                     // in either frame
    double error = 0.0;                       // ||(I' - I) - (R' - R)|| / ||R' - R||; infinite where R does not change
    std::optional<HalvesDifferences> halves;  // the same of the changes, with two halves
};

// Which pixels are finite in the image and the reference of each of two frames.
struct UsableFrames {
    std::vector<bool> frame, next;
    NotFinite not_finite;  // in either
};

// All of one size and with as many halves. Throws Error BadData when they are not.
UsableFrames usable_frames(const FrameAndReference& frame, const FrameAndReference& next);
TemporalError compare_changes(const FrameAndReference& frame, const FrameAndReference& next);

}  // namespace brisance
