#include "report_json.h"

#include <cmath>

namespace brisance {
namespace {

using Json = nlohmann::ordered_json;

Json optional_number(const std::optional<double>& value) {
    return value ? json_number(*value) : Json();
}

Json spread_json(const std::optional<ErrorSpread>& spread) {
    if (!spread)
        return nullptr;
    return {{"noise_free", optional_number(spread->noise_free)},
            {"rrmse", json_number(spread->rrmse)},
            {"relmse", json_number(spread->relmse)},
            {"mape", json_number(spread->mape)},
            {"mean", json_number(spread->mean)},
            {"flip", json_number(spread->flip)}};
}

Json errors_json(const LayerErrors& errors) {
    return {{"noise_free", optional_number(errors.noise_free)},
            {"rrmse", json_number(errors.differences.rrmse)},
            {"relmse", json_number(errors.differences.relmse)},
            {"mape", json_number(errors.differences.mape)},
            {"mean", json_number(errors.differences.mean)},
            {"flip", json_number(errors.flip)},
            {"spread", spread_json(errors.spread)},
            {"below_noise", errors.below_noise},
            {"not_finite", {{"image", errors.not_finite.image}, {"reference", errors.not_finite.reference}}}};
}

Json run_json(const MeasuredRun& run) {
    Json errors = Json::object();
    for (const auto& [layer, values] : run.errors)
        errors[layer] = errors_json(values);
    return {{"id", run.id},
            {"label", run.step.label},
            {"settings", run.step.settings},
            {"command", run.command},
            {"wall_seconds", run.cost.wall_seconds},
            {"cpu_seconds", run.cost.cpu_seconds},
            {"samples_per_pixel", run.samples_per_pixel},
            {"errors", std::move(errors)},
            {"statistics", run.statistics.to_json()}};
}

Json times_json(const ErrorCurve& curve) {
    Json times = Json::array();
    for (const double target : report_targets()) {
        const Reading reading = curve.time_to(target);
        const bool reached = reading.kind != ReadingKind::NotReached;
        times.push_back({{"target", target},
                         {"seconds", reached ? json_number(reading.value) : Json()},
                         {"kind", name_of(reading.kind)},
                         {"floor", curve.floor()}});
    }
    return times;
}

Json errors_after_json(const ErrorCurve& curve, const std::vector<double>& times) {
    Json errors = Json::array();
    for (const double seconds : times) {
        const Reading reading = curve.error_after(seconds);
        const bool there = reading.kind != ReadingKind::NotReached;
        errors.push_back({{"seconds", seconds},
                          {"error", there ? json_number(reading.value) : Json()},
                          {"kind", name_of(reading.kind)}});
    }
    return errors;
}

// Slope, times to errors and errors after times, of every layer by either clock.
Json convergence_json(const Report& report, const MethodResult& result) {
    Json json = Json::object();
    for (const std::string& layer : report.layers)
        for (const auto& [clock, name] : {std::pair{Clock::Wall, "wall"}, {Clock::Cpu, "cpu"}}) {
            const ErrorCurve curve = curve_of(report, result, layer, clock);
            if (curve.points().empty())
                continue;
            const std::optional<PowerLaw> law = curve.law(), of_work = curve.law_of_work();
            json[layer][name] = {{"slope", law ? json_number(law->exponent) : Json()},
                                 {"constant", law ? json_number(law->constant) : Json()},
                                 {"startup_seconds", json_number(curve.startup())},
                                 {"slope_in_paths", of_work ? json_number(of_work->exponent) : Json()},
                                 {"times", times_json(curve)},
                                 {"errors", errors_after_json(curve, equal_times(report, clock))}};
        }
    return json;
}

Json cells_json(const CellSet& cells) {
    Json names = Json::array();
    for (std::size_t cell = 0; cell < kCells; ++cell)
        if (cells[cell])
            names.push_back(kCellNames[cell]);
    return names;
}

Json method_json(const Report& report, const MethodResult& result) {
    Json runs = Json::array();
    for (const MeasuredRun& run : result.runs)
        runs.push_back(run_json(run));
    Json flicker = Json::object();
    for (const auto& [cell, value] : result.flicker)
        flicker[cell] = json_number(value);
    return {{"label", result.method.label},
            {"base", result.method.base},
            {"settings", result.method.settings},
            {"cells", cells_json(result.method.cells)},
            {"unbiased", result.method.unbiased},
            {"converges", result.method.averages},
            {"convergence", convergence_json(report, result)},
            {"flicker", std::move(flicker)},
            {"runs", std::move(runs)}};
}

Json reference_json(const ReferenceSummary& reference) {
    Json noise = Json::object();
    for (const auto& [layer, value] : reference.noise)
        noise[layer] = json_number(value);
    return {{"label", reference.label},
            {"description", reference.description},
            {"files", reference.files},
            {"command", reference.command},
            {"halves", reference.halves},
            {"samples_per_pixel", reference.samples_per_pixel},
            {"wall_seconds", reference.cost.wall_seconds},
            {"cpu_seconds", reference.cost.cpu_seconds},
            {"noise", std::move(noise)},
            {"notices", reference.notices}};
}

Json machine_json(const Machine& machine) {
    return {{"processor", machine.processor},
            {"cores", machine.cores},
            {"logical", machine.logical},
            {"threads", machine.threads},
            {"memory_bytes", machine.memory_bytes},
            {"load", machine.load},
            {"system", machine.system}};
}

Json shot_json(const ReportedShot& shot) {
    return {{"name", shot.name},
            {"input", shot.input},
            {"volume", shot.volume},
            {"frame", shot.frame},
            {"width", shot.width},
            {"height", shot.height},
            {"settings_hash", shot.settings_hash},
            {"resolved", Json::parse(shot.json, nullptr, false)}};
}

Json time_json(const Report& report) {
    std::string included =
        "A run's time is the method's own work from the medium to the finished picture: for lighting_grid lights, "
        "hierarchy, shadow maps, gathering, scattering and camera; for path its acceleration structures, all paths, "
        "and depth and coverage.";
    if (report.repeats > 1)
        included += " It is the median of " + std::to_string(report.repeats) + " renders, errors are their means.";
    return {{"included", included},
            {"excluded",
             "Not part of it: reading the volume and building the medium, which all runs share, comparing, "
             "and writing files."},
            {"loading_seconds", report.loading_seconds},
            {"processors_busy", processors_busy(report)},
            {"disturbed", was_disturbed(report)},
            {"repeats", report.repeats}};
}

}  // namespace

nlohmann::ordered_json json_number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

const char* name_of(ReadingKind kind) {
    switch (kind) {
        case ReadingKind::Interpolated:
            return "interpolated";
        case ReadingKind::Extrapolated:
            return "extrapolated";
        case ReadingKind::AtMost:
            return "at_most";
        case ReadingKind::NotReached:
            break;
    }
    return "not_reached";
}

Json report_json(const Report& report) {
    Json methods = Json::array();
    for (const MethodResult& result : report.methods)
        methods.push_back(method_json(report, result));
    Json failures = Json::array();
    for (const MethodFailure& failure : report.failures)
        failures.push_back({{"method", failure.method}, {"reason", failure.reason}});
    return {{"schema_version", 1},
            {"brisance", report.version},
            {"date", report.date},
            {"command", report.command},
            {"shot", shot_json(report.shot)},
            {"machine", machine_json(report.machine)},
            {"time", time_json(report)},
            {"measure", report.reference.halves ? "noise_free" : "rrmse"},
            {"targets", report_targets()},
            {"baseline", baseline(report)},
            {"equal_times", {{"wall", equal_times(report, Clock::Wall)}, {"cpu", equal_times(report, Clock::Cpu)}}},
            {"strip_frames", report.strip_frames},
            {"layers", report.layers},
            {"reference", reference_json(report.reference)},
            {"methods", std::move(methods)},
            {"failures", std::move(failures)}};
}

}  // namespace brisance
