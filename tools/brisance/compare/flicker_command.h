// `brisance flicker`: how much a still changes that ought not to change, without a reference.
#pragma once

#include <string>
#include <vector>

#include "progress.h"

namespace CLI {
class App;
}

namespace brisance {

struct FlickerOptions {
    std::string input;   // a shot file, or a .vdb with or without frame tokens
    std::string frames;  // -f: one frame; empty: the only one on disk
    std::string preset;
    std::vector<std::string> overrides;
    int width = 160;         // of the pictures, which keep their shape [pixels]
    double fail_above = -1;  // of the picture's change; below 0: nothing fails
    bool as_json = false;
    int threads = 0;
    ProgressStyle progress = ProgressStyle::Automatic;
};

// Options of the command alone; those of all commands that render come besides.
void add_flicker_options(CLI::App& command, FlickerOptions& options);

// Renders one frame again with nothing changed, moved by an eighth of a voxel and by whole ones together with its
// camera, in a larger bounding box, and with other seeds, and prints by how much picture and layers change. Returns 1
// when the picture of a variant changes by more than `fail_above`, else 0. Throws Error.
int run_flicker(const FlickerOptions& options);

}  // namespace brisance
