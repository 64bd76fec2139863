// `brisance report`: methods at several budgets against a reference, as a page, CSV and JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "methods.h"
#include "progress.h"

namespace brisance {

struct ReportOptions {
    std::vector<std::string> inputs;  // of the command line; one without a suite, with it any number of further scenes
    std::string input;                // a shot file, or a .vdb with or without frame tokens
    std::string suite;                // of suite_sizes(); empty: one shot
    std::string shots = "shots";      // the folder with the shots of a suite
    std::vector<std::string> scenes;  // of a suite; empty: all
    std::optional<int> strip_frames;  // of the film strips of a suite, 0: none; empty: as the suite says
    std::string output = "report.html";  // CSV and JSON go beside it
    std::string frame;                   // -f; empty: the only one on disk
    std::string preset;
    std::vector<std::string> overrides;
    MethodOptions methods;
    std::vector<std::string> references;  // EXR files; empty: a reference is made
    int reference_samples = 0;            // of the one that is made; 0: by reference_seconds, or enough for the budgets
    double reference_seconds = 0.0;       // 0: no limit
    std::vector<double> exposures = {-3.0, 0.0, 3.0};  // of pictures in the page, beside the shot's [stops]
    int picture_width = 480;                           // of pictures in the page, at most [pixels]
    int repeats = 1;
    int threads = 0;  // 0: all processors
    ProgressStyle progress = ProgressStyle::Automatic;
    std::vector<std::string> command_line;  // as the page shows it
};

// Prints the times to reach errors, and the paths of the files, to standard output. Throws Error. Nothing is written
// before all is measured; each file appears whole, the page last.
int run_report(const ReportOptions& options);

}  // namespace brisance
