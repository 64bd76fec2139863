// `brisance trace-path`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "progress.h"

namespace brisance {

struct TracePathOptions {
    std::string input;   // a shot file, or a .vdb with or without frame tokens
    std::string frames;  // -f: one frame; empty: the only one on disk
    std::string preset;
    std::vector<std::string> overrides;
    int threads = 0;
    ProgressStyle progress = ProgressStyle::None;
    int x = 0;
    int y = 0;
    std::uint64_t sample = 0;
};

// Prints one path of method path to standard output. Returns the exit code: RenderFailed when what the path brings is
// not finite. Throws Error.
int run_trace_path(const TracePathOptions& options);

}  // namespace brisance
