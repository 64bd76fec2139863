// `brisance plan`, and the files that frames read.
#pragma once

#include "frame_job.h"

namespace brisance {

struct PlanOptions {
    RenderOptions render;
    bool as_json = false;  // with what every frame is expected to need
};

// Prints what a render would read and do, to standard output. Throws Error.
int run_plan(const PlanOptions& options);

// Prints every file that the frames asked for read, one on each line, each once: the shot first, and what decides for
// all frames. Returns the exit code.
// Throws Error MissingInput for the first that is not there.
int list_inputs(const LoadedShot& loaded, const RenderOptions& options, TextProgress& progress);

}  // namespace brisance
