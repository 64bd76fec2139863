// `brisance submit`: renders a sequence by tasks, on this machine or on a farm.
#pragma once

#include <string>
#include <vector>

#include "render_command.h"

namespace brisance {

struct SubmitOptions {
    RenderOptions render;
    std::string engine = "local";
    int tasks = 0;                       // 0: one for each frame, on this machine one for all
    int frames_a_task = 0;               // 0: by `tasks`
    int retries = 2;                     // of a task that failed
    std::uint64_t memory_mebibytes = 0;  // of a task; 0: what the frame with the largest file may need
    std::vector<std::string> engine_options;
    std::string write;  // writes the job to this file instead of submitting it; empty: submits
};

const std::vector<std::string>& farm_engines();

// Returns the exit code: engine local, that of `brisance verify` once all is done; others, 0 once the job is submitted
// or written. Throws Error: Usage, Unavailable (no program to submit with, or it refuses), and as run_render.
int run_submit(const SubmitOptions& options);

}  // namespace brisance
