// The results of `brisance compare`: as text, as JSON, and against limits.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "metrics/comparison.h"
#include "metrics/flicker.h"
#include "metrics/temporal_spectrum.h"

namespace brisance {

struct ComparedFrame {
    std::optional<int> frame;  // absent: the file does not say
    std::filesystem::path image;
    std::vector<std::filesystem::path> references;           // one, or two halves
    std::optional<double> render_seconds;                    // of the image
    std::vector<std::pair<std::string, Comparison>> layers;  // "" is the beauty; maps of errors may be empty
};

// Errors of the change from a frame to the next.
struct ChangeErrors : TemporalError {
    std::optional<Flicker> flicker;  // absent: the motion is not known
};

// From one compared frame to the next.
struct ComparedChange {
    int from = 0;
    int to = 0;
    std::vector<std::pair<std::string, ChangeErrors>> layers;
};

struct CompareReport {
    double pixels_per_degree = kPixelsPerDegree;
    std::vector<std::string> overruled;  // differences of shots that --force set aside
    std::vector<ComparedFrame> frames;
    std::vector<ComparedChange> changes;
    std::vector<std::pair<std::string, TemporalSpectrum>> spectra;  // by layer; of at least kSpectrumFrames frames
};

// Fewer frames have no bands worth the name.
constexpr std::size_t kSpectrumFrames = 4;

// A measure and how large it may become. `mean` counts by its magnitude.
struct Limit {
    std::string metric;
    double value = 0.0;
};

// Names of measures, "rrmse", "noise_free", ...
std::vector<std::string> metric_names();

// From "rrmse=0.02". `halves`: there are two references; `several_frames`: there are changes to measure. Throws Error
// Usage for text that is not a limit, and for a measure that is not computed.
Limit parse_limit(const std::string& text, bool halves, bool several_frames);

// One line for each layer and frame that exceeds a limit, whose measure is not a number, or that has pixels that are
// not finite: what cannot be measured does not pass.
std::vector<std::string> exceeded_limits(const CompareReport& report, const std::vector<Limit>& limits);

// "beauty" for "".
std::string shown_layer(const std::string& layer);

std::string report_text(const CompareReport& report);
std::string report_json(const CompareReport& report, const std::vector<std::string>& exceeded);

}  // namespace brisance
