// What `render`, `plan`, `verify` and `submit` have in common: the shot of a command line, its frames, and what is
// decided for all of them.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "progress.h"
#include "render/choose_method.h"
#include "render/render_frame.h"
#include "render/time_budget.h"
#include "render_command.h"
#include "volume/frame_path.h"

namespace brisance {

struct Failures {
    std::size_t count = 0;
    ExitCode first = ExitCode::Success;
};

// Runs `work`; what it throws becomes a line and is counted. Returns whether it came to its end.
bool attempt(const std::string& what, const std::function<void()>& work, TextProgress& progress, Failures& failures);

// The shot with all overrides of the command line. Throws Error.
Shot load_for(const RenderOptions& options, Progress& progress);

struct FrameJob {
    std::vector<FrameFile> frames;  // of this task
    bool several = false;           // of all tasks together
};

// The frames asked for, without a look at their files. Throws Error Usage, or MissingInput where none is on disk.
std::vector<int> frames_asked_for(const Shot& shot, const RenderOptions& options);

// Files of all frames, each of them there and recognisably whole, before the first is rendered: a mistake in frame 90
// should not cost the time of 89 frames. With --keep-going the others remain. Throws Error.
FrameJob usable_frames(const Shot& shot, const RenderOptions& options, TextProgress& progress, Failures& failures);

// What was chosen for all frames, before the first.
struct SharedChoice {
    std::optional<TimedSettings> timed;
    std::optional<MethodForecast> method;

    void note(bool first, RenderedFrame& frame) const;
};

// By the largest file on disk that can be read, whichever frames this call renders: the method, and the settings for a
// time. They are in `shot` then.
SharedChoice choose_for_all(Shot& shot, Progress& progress);

// The files by which something is chosen for all frames.
std::vector<std::filesystem::path> deciding_files(const Shot& shot);

}  // namespace brisance
