// `brisance verify`: whether the frames asked for are finished.
#pragma once

#include "frame_job.h"

namespace brisance {

struct VerifyOptions {
    RenderOptions render;  // those that decide which frames, and what is in them
};

// Prints a line to standard output for each frame that is not finished, and the sum to standard error. Returns the exit
// code: 0, or that of RenderFailed where a frame is not. Throws Error where the frames cannot be named or an input
// cannot be read.
int run_verify(const VerifyOptions& options);

}  // namespace brisance
