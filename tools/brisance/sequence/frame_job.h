// What `render`, `plan`, `verify` and `submit` have in common: the shot of a command line, its frames, and what is
// decided for all of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "load_shot.h"
#include "progress.h"
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
LoadedShot load_for(const RenderOptions& options, Progress& progress);

struct FrameJob {
    std::vector<FrameFile> frames;  // of this task
    bool several = false;           // of all tasks together
};

// The frames asked for, without a look at their files. Throws Error Usage, or MissingInput where none is on disk.
std::vector<int> frames_asked_for(const Shot& shot, const RenderOptions& options);

// Files of all frames, each of them there and recognisably whole, before the first is rendered: a mistake in frame 90
// should not cost the time of 89 frames. With --keep-going the others remain. Throws Error.
FrameJob usable_frames(const Shot& shot, const RenderOptions& options, TextProgress& progress, Failures& failures);

}  // namespace brisance
