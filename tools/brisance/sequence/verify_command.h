// `brisance verify`: whether the frames asked for are finished.
#pragma once

#include "frame_job.h"

namespace brisance {

struct VerifyOptions {
    RenderOptions render;    // those that decide which frames, and what is in them
    double fail_above = -1;  // of a frame's change against both neighbours; below 0: nothing fails
};

// Prints a line to standard output for each frame that is not finished or changes too much, and the sum to standard
// error, with how much frames change against both neighbours (steadiness.h). Returns the exit code: 0, or that of
// RenderFailed where there is such a frame. Throws Error where the frames cannot be named or an input
// cannot be read.
int run_verify(const VerifyOptions& options);

}  // namespace brisance
