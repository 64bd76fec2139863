// `brisance render`.
#pragma once

#include <string>
#include <vector>

#include "progress.h"
#include "sequence/result_cache.h"

namespace brisance {

inline constexpr const char* kDebugVirtualLights = "virtual-lights";

struct RenderOptions {
    std::string input;   // a shot file, a .vdb with or without frame tokens, or a folder of them
    std::string output;  // -o; empty: the shot's, or by name
    std::string frames;  // -f; empty: those on disk
    std::string preset;
    std::string look;      // file of a first look, or "auto"; empty: decided for a bare volume, none for a shot
    std::string method;    // of rendering; empty: the shot's
    double seconds = 0.0;  // for a frame; 0: as the shot says
    std::vector<std::string> overrides;
    std::string checkpoint;          // file that keeps the state of a long render, to resume it; empty: none
    std::vector<std::string> debug;  // pictures of how a method works: kDebugVirtualLights
    CacheOptions cache;
    bool certify = false;  // also where the shot does not enable it
    int threads = 0;       // 0: all processors
    int task_index = 0;    // from 0
    int task_count = 0;    // of the farm; 0: this process renders all frames
    bool explain = false;
    bool print_config = false;
    bool list_inputs = false;
    bool skip_existing = false;
    bool keep_going = false;
    bool make_folders = false;
    ProgressStyle progress = ProgressStyle::Automatic;
};

// Renders every frame and writes the paths of finished files to standard output. Returns the exit code, with
// --keep-going that of a failed frame. Throws Error for everything that concerns all frames.
int run_render(const RenderOptions& options);

}  // namespace brisance
