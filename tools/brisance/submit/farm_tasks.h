// The tasks of a submitted sequence, as command lines.
#pragma once

#include <string>
#include <vector>

#include "submit_command.h"

namespace brisance {

using Words = std::vector<std::string>;

struct FarmTasks {
    std::string name;           // of the job
    std::string program;        // this one, absolute
    std::string folder;         // the current one, absolute: relative paths of the command line are relative to it
    std::string output_folder;  // of the first frame, absolute
    std::string frames;         // as for --frames
    std::vector<int> frame_list;
    int count = 1;
    int retries = 0;
    std::uint64_t memory_bytes = 0;  // of a task
    RenderOptions render;

    // `command`: render or verify; with the options of the command line that decide frames and pictures.
    Words command(const std::string& command) const;
    // Task `index`, which may be a variable of the engine's. Frames that are finished are left out, so that a task can
    // be run again.
    Words task(const std::string& index) const;
    // Renders whatever is missing, by one process.
    Words rest() const;
};

// Checks the shot, the frames and the outputs as `render` does, and divides the frames. Throws Error.
FarmTasks plan_tasks(const SubmitOptions& options);

// For a shell, quoted where it must be. Words that begin with $ are variables, and are put into double quotes.
std::string shell_line(const Words& words);

}  // namespace brisance
