#include "report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report_json.h"

namespace brisance {
namespace {

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char c : text)
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

// Empty where there is no number.
std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "";
}

std::string csv_number(const std::optional<double>& value) {
    return value ? csv_number(*value) : "";
}

std::string csv_row(const std::vector<std::string>& fields) {
    std::string row;
    for (std::size_t i = 0; i < fields.size(); ++i)
        row += fmt::format("{}{}", i == 0 ? "" : ",", csv_field(fields[i]));
    return row + "\r\n";
}

std::string shown_layer(const std::string& layer) {
    return layer.empty() ? "beauty" : layer;
}

std::optional<double> noise_of(const Report& report, const std::string& layer) {
    const auto found = report.reference.noise.find(layer);
    return found == report.reference.noise.end() ? std::nullopt : std::optional(found->second);
}

std::string measurement_row(const Report& report, const MethodResult& result, const MeasuredRun& run,
                            const std::string& layer, const LayerErrors& errors) {
    std::vector<std::string> settings = result.method.settings;
    settings.insert(settings.end(), run.step.settings.begin(), run.step.settings.end());
    const auto spread = [&](const auto& measure) { return errors.spread ? csv_number(measure(*errors.spread)) : ""; };
    return csv_row({report.shot.name,
                    std::to_string(report.shot.frame),
                    result.method.label,
                    run.step.label,
                    fmt::format("{}", fmt::join(settings, " ")),
                    shown_layer(layer),
                    csv_number(run.samples_per_pixel),
                    csv_number(run.cost.wall_seconds),
                    csv_number(run.cost.cpu_seconds),
                    csv_number(errors.noise_free),
                    csv_number(errors.differences.rrmse),
                    csv_number(errors.differences.relmse),
                    csv_number(errors.differences.mape),
                    csv_number(errors.differences.mean),
                    csv_number(errors.flip),
                    csv_number(noise_of(report, layer)),
                    errors.below_noise ? "yes" : "no",
                    std::to_string(errors.not_finite.image),
                    std::to_string(errors.not_finite.reference),
                    &run == &result.runs.front() ? csv_number(flicker_in(result, layer)) : "",
                    std::to_string(report.repeats),
                    spread([](const ErrorSpread& s) { return s.noise_free; }),
                    spread([](const ErrorSpread& s) { return s.rrmse; }),
                    spread([](const ErrorSpread& s) { return s.relmse; }),
                    spread([](const ErrorSpread& s) { return s.mape; }),
                    spread([](const ErrorSpread& s) { return s.mean; }),
                    spread([](const ErrorSpread& s) { return s.flip; })});
}

void add_times(const Report& report, const std::string& layer, Clock clock, std::string& csv) {
    const ErrorCurve base = curve_of(report, report.methods[baseline(report)], layer, clock);
    for (const MethodResult& result : report.methods) {
        const ErrorCurve curve = curve_of(report, result, layer, clock);
        if (curve.points().empty())
            continue;
        const std::optional<PowerLaw> law = curve.law(), of_work = curve.law_of_work();
        for (const double target : report_targets()) {
            const Reading reading = curve.time_to(target), first = base.time_to(target);
            const bool reached = reading.kind != ReadingKind::NotReached;
            const double ratio = reached && first.kind != ReadingKind::NotReached ? reading.value / first.value : NAN;
            csv += csv_row({result.method.label, shown_layer(layer), clock == Clock::Wall ? "wall" : "cpu",
                            csv_number(target), reached ? csv_number(reading.value) : "", name_of(reading.kind),
                            csv_number(ratio), csv_number(curve.floor()), law ? csv_number(law->exponent) : "",
                            csv_number(curve.startup()), of_work ? csv_number(of_work->exponent) : "",
                            report.methods[baseline(report)].method.label});
        }
    }
}

std::string seconds_text(double seconds) {
    if (seconds < 600.0)
        return fmt::format("{:.3g} s", seconds);
    return seconds < 7200.0 ? fmt::format("{:.3g} min", seconds / 60.0) : fmt::format("{:.3g} h", seconds / 3600.0);
}

// Whole digits for large ratios: "1.2e+02" is for nobody.
std::string ratio_text(double ratio) {
    return fmt::format("{:.{}f}", ratio, ratio < 10.0 ? 1 : 0);
}

std::string reading_text(const Reading& reading, const Reading& base, double floor) {
    switch (reading.kind) {
        case ReadingKind::NotReached:
            return fmt::format("not reached (bias floor {:.2g} %)", 100.0 * floor);
        case ReadingKind::AtMost:
            return fmt::format("<= {}", seconds_text(reading.value));
        case ReadingKind::Interpolated:
        case ReadingKind::Extrapolated:
            break;
    }
    std::string text =
        fmt::format("{}{}", reading.kind == ReadingKind::Extrapolated ? "~ " : "", seconds_text(reading.value));
    if (base.kind != ReadingKind::NotReached && base.value > 0.0)
        text += fmt::format(" ({}x)", ratio_text(reading.value / base.value));
    return text;
}

std::vector<std::string> table_row(const Report& report, const MethodResult& result) {
    const ErrorCurve base = curve_of(report, report.methods[baseline(report)], "", Clock::Wall);
    const ErrorCurve curve = curve_of(report, result, "", Clock::Wall);
    const std::optional<PowerLaw> law = curve.law();
    std::vector<std::string> row = {result.method.label, law ? fmt::format("{:.2f}", law->exponent) : "-"};
    for (const double target : report_targets())
        row.push_back(reading_text(curve.time_to(target), base.time_to(target), curve.floor()));
    return row;
}

// Seconds of the stages of that name [s].
double seconds_in(const MeasuredRun& run, const std::string& stage) {
    double seconds = 0.0;
    for (const StageCost& cost : run.statistics.stages)
        seconds += cost.name == stage ? cost.seconds : 0.0;
    return seconds;
}

std::vector<std::string> surface_row(const Report& report, const MethodResult& result, const MeasuredRun& run) {
    const auto percent = [&](const std::string& layer) {
        const std::optional<double> error = headline_error(report, run, layer);
        const std::optional<double> spread = headline_spread(report, run, layer);
        const std::string bar = spread ? fmt::format(" +- {:.2g}", 100.0 * *spread) : "";
        return error ? fmt::format("{:.3g}{} %", 100.0 * *error, bar) : "-";
    };
    const auto mean = run.errors.find("SS");
    return {result.method.label,
            run.step.label,
            fmt::format("{:.2f}", seconds_in(run, "virtual lights")),
            fmt::format("{:.2f}", seconds_in(run, "camera")),
            fmt::format("{:.2f}", run.cost.wall_seconds),
            fmt::format("{:.2f}", run.cost.cpu_seconds),
            percent("SS"),
            mean == run.errors.end() ? "-" : fmt::format("{:+.2f} %", 100.0 * mean->second.differences.mean),
            percent("")};
}

std::string aligned(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            line += fmt::format("{:<{}}", row[i], i + 1 < row.size() ? widths[i] + 3 : 0);
        text += line + "\n";
    }
    return text;
}

}  // namespace

std::string measurements_csv(const Report& report) {
    std::string csv = csv_row({"shot",
                               "frame",
                               "method",
                               "step",
                               "settings",
                               "layer",
                               "samples_per_pixel",
                               "wall_seconds",
                               "cpu_seconds",
                               "rrmse_noise_free",
                               "rrmse",
                               "relmse",
                               "mape",
                               "bias",
                               "hdr_flip",
                               "reference_noise",
                               "below_reference_noise",
                               "image_pixels_not_finite",
                               "reference_pixels_not_finite",
                               "flicker",
                               "repeats",
                               "rrmse_noise_free_sd",
                               "rrmse_sd",
                               "relmse_sd",
                               "mape_sd",
                               "bias_sd",
                               "hdr_flip_sd"});
    for (const MethodResult& result : report.methods)
        for (const MeasuredRun& run : result.runs)
            for (const auto& [layer, errors] : run.errors)
                csv += measurement_row(report, result, run, layer, errors);
    return csv;
}

std::string times_csv(const Report& report) {
    std::string csv = csv_row({"method", "layer", "clock", "error", "seconds", "kind", "ratio_to_baseline",
                               "smallest_error", "slope", "startup_seconds", "slope_in_paths", "baseline"});
    for (const std::string& layer : report.layers)
        for (const Clock clock : {Clock::Wall, Clock::Cpu})
            add_times(report, layer, clock, csv);
    return csv;
}

std::string surface_table(const Report& report) {
    if (std::find(report.layers.begin(), report.layers.end(), "SS") == report.layers.end())
        return "";
    std::vector<std::vector<std::string>> rows = {
        {"method", "step", "prepare s", "shade s", "wall s", "CPU s", "SS error", "SS mean", "beauty error"}};
    for (const MethodResult& result : report.methods)
        for (const MeasuredRun& run : result.runs)
            rows.push_back(surface_row(report, result, run));
    return "light from surfaces on surfaces (SS): rRMSE, and relative error of the mean; prepare: virtual lights; "
           "shade: "
           "camera and all cells" +
           (report.repeats > 1 ? fmt::format("; means of {} renders, +- the standard deviation of one", report.repeats)
                               : std::string()) +
           "\n" + aligned(rows);
}

std::string times_table(const Report& report) {
    std::vector<std::vector<std::string>> rows = {{"method", "slope"}};
    for (const double target : report_targets())
        rows[0].push_back(fmt::format("{:g} %", 100.0 * target));
    for (const MethodResult& result : report.methods)
        rows.push_back(table_row(report, result));
    const auto noise = noise_of(report, "");
    std::string text = fmt::format(
        "wall time to reach an rRMSE{}, {} thread{}; ~ extrapolated, <= reached by the cheapest run, (x) times that of "
        "{}\n",
        report.reference.halves ? " (free of the reference's noise)" : "", report.machine.threads,
        report.machine.threads == 1 ? "" : "s", report.methods[baseline(report)].method.label);
    text += aligned(rows);
    text += fmt::format("reference: {}{}\n", report.reference.description,
                        noise ? fmt::format("; its own noise {:.2g} %", 100.0 * *noise) : "");
    if (was_disturbed(report))
        text += fmt::format(
            "only {:.1f} of {} processors were busy with rendering: other work disturbed the wall times, or parts of "
            "it "
            "are serial; the page also has CPU times\n",
            processors_busy(report), report.machine.threads);
    return text;
}

}  // namespace brisance
