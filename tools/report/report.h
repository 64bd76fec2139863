// The data of a report: methods measured against a reference, at several steps each.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "error_curve.h"
#include "machine.h"
#include "methods.h"
#include "metrics/comparison.h"
#include "statistics/statistics.h"

namespace brisance {

// Time of one render.
struct Cost {
    double wall_seconds = 0.0;
    double cpu_seconds = 0.0;  // of all threads, user and system
};

// Standard deviation of each measure of one render, over renders with other random numbers (n - 1 in the denominator).
// That of the mean over n of them is smaller by sqrt(n).
struct ErrorSpread {
    std::optional<double> noise_free;  // with two halves
    double rrmse = 0.0;
    double relmse = 0.0;
    double mape = 0.0;
    double mean = 0.0;
    double flip = 0.0;
};

// Errors of one layer, the mean over the repeats. Relative to the reference, but for flip in [0, 1].
struct LayerErrors {
    std::optional<double> noise_free;  // with two halves
    Differences differences;
    double flip = 0.0;
    NotFinite not_finite;
    bool below_noise = false;  // differences.rrmse measures the noise of the reference rather than the image
    std::optional<ErrorSpread> spread = {};  // absent: one render, or all repeats gave the same picture
};

struct MeasuredRun {
    std::string id;  // of its pictures in the page
    MethodStep step;
    std::vector<std::string> settings;  // of method and step, over those of the shot
    std::string command;                // that repeats the render
    Cost cost;                          // median of the repeats, by wall time
    double samples_per_pixel = 0.0;
    Statistics statistics;
    std::map<std::string, LayerErrors> errors;  // by layer, "" the beauty
};

struct MethodResult {
    Method method;
    std::vector<MeasuredRun> runs;
    std::map<std::string, double> flicker = {};  // of the first run, by cell (film_strip.h); empty: not measured
};

// A method, or a step of it, that gave no picture.
struct MethodFailure {
    std::string method;
    std::string reason;  // one line
};

struct ReferenceSummary {
    std::string label;                    // "1024 spp"
    std::string description;              // one sentence
    std::vector<std::string> files;       // given ones
    std::string command;                  // that makes one like it; empty: given
    bool halves = false;                  // two independent ones
    double samples_per_pixel = 0.0;       // 0: not known
    Cost cost;                            // 0: given
    std::map<std::string, double> noise;  // rRMSE by layer; absent: not known
    std::vector<std::string> notices;
};

struct ReportedShot {
    std::string name;
    std::string input;
    std::string volume;  // file name
    int frame = 0;
    int width = 0;
    int height = 0;
    std::string settings_hash;
    std::string json;  // resolved
};

struct Report {
    std::string version;
    std::string date;  // 2025-01-31T12:00:00Z
    std::string command;
    ReportedShot shot;
    Machine machine;
    double loading_seconds = 0.0;  // reading the volume and building the medium, shared by all runs
    int repeats = 1;
    int strip_frames = 0;             // of film strips; 0: there are none
    std::vector<std::string> layers;  // of the reference: "" and its cells
    ReferenceSummary reference;
    std::vector<MethodResult> methods;
    std::vector<MethodFailure> failures;
};

// The errors that times are read off for, from the largest.
const std::vector<double>& report_targets();

enum class Clock { Wall, Cpu };

// The measure that counts: free of the reference's noise where that can be had. Absent when the run lacks the layer.
std::optional<double> headline_error(const Report& report, const MeasuredRun& run, const std::string& layer);

// Its standard deviation from repeat to repeat. Absent where it has none.
std::optional<double> headline_spread(const Report& report, const MeasuredRun& run, const std::string& layer);

// Of the method's first run in a cell. Absent where it was not measured, and where there is no light.
std::optional<double> flicker_in(const MethodResult& result, const std::string& cell);

ErrorCurve curve_of(const Report& report, const MethodResult& result, const std::string& layer, Clock clock);

// The method that ratios are relative to: of those that reach most errors (beauty, wall time) the first.
std::size_t baseline(const Report& report);

// Processors that rendering kept busy, in the mean over all runs.
double processors_busy(const Report& report);

// Far fewer than there are threads: other work on the machine, or serial parts. Wall times then say little.
bool was_disturbed(const Report& report);

// Round times [s] within those of all runs, at which methods are compared.
std::vector<double> equal_times(const Report& report, Clock clock);

// Seconds now since 1970, or SOURCE_DATE_EPOCH, as a date in UTC. Throws Error Usage when that is no number.
std::string report_date();

// For a POSIX shell: quoted only where it must be.
std::string shell_quoted(const std::string& word);

}  // namespace brisance
