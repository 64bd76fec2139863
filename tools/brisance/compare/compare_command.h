// `brisance compare`: how far an image, or a sequence, is from a reference.
#pragma once

#include <string>
#include <vector>

#include "metrics/flip.h"

namespace brisance {

struct CompareOptions {
    std::string image;                    // EXR, with or without frame tokens
    std::vector<std::string> references;  // one, or two independent halves; EXR as above
    std::string frames;                   // -f; empty: those of the image on disk
    std::string layers;                   // "V+MV": their sum instead of the beauty
    std::string motion;                   // layer with motion vectors; empty: the cameras' movement at the depth Z
    std::string flip_map;                 // PNG, with frame tokens for several frames; empty: none
    std::string spectrum;                 // HTML page of the errors over time; empty: none
    std::vector<std::string> limits;      // "rrmse=0.02"
    double pixels_per_degree = kPixelsPerDegree;
    bool cells = false;  // every layer that all have
    bool as_json = false;
    bool force = false;  // though the shots differ
};

// Prints to standard output. Returns the exit code: 0, or 1 when a limit is exceeded, each on a line of standard error.
// Throws Error BadData when the images cannot be compared or, without `force`, are of different shots; all reasons are
// in its one line.
int run_compare(const CompareOptions& options);

}  // namespace brisance
