#include "compare/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/spectrum_table.h"
#include "compare/text_table.h"
#include "core/error.h"

namespace brisance {
namespace {

using Json = nlohmann::ordered_json;

template <class Result>
struct Metric {
    const char* name;
    std::optional<double> (*of)(const Result&);  // absent: not computed
};

template <class Result>
std::optional<double> noise_free(const Result& result) {
    return result.halves ? std::optional(result.halves->noise_free) : std::nullopt;
}

template <class Result>
std::optional<double> reference_noise(const Result& result) {
    return result.halves ? std::optional(result.halves->reference_noise) : std::nullopt;
}

const std::vector<Metric<Comparison>>& still_metrics() {
    using Value = std::optional<double>;
    static const std::vector<Metric<Comparison>> metrics = {
        {"rrmse", [](const Comparison& c) { return Value(c.differences.rrmse); }},
        {"noise_free", noise_free<Comparison>},
        {"reference_noise", reference_noise<Comparison>},
        {"relmse", [](const Comparison& c) { return Value(c.differences.relmse); }},
        {"mape", [](const Comparison& c) { return Value(c.differences.mape); }},
        {"mean", [](const Comparison& c) { return Value(c.differences.mean); }},
        {"flip", [](const Comparison& c) { return Value(c.flip.mean); }},
    };
    return metrics;
}

const std::vector<Metric<ChangeErrors>>& change_metrics() {
    using Value = std::optional<double>;
    static const std::vector<Metric<ChangeErrors>> metrics = {
        {"temporal", [](const ChangeErrors& e) { return Value(e.error); }},
        {"temporal_noise_free", noise_free<ChangeErrors>},
        {"temporal_reference_noise", reference_noise<ChangeErrors>},
        {"flicker", [](const ChangeErrors& e) { return e.flicker ? Value(e.flicker->error) : Value(); }},
        {"flicker_noise_free", [](const ChangeErrors& e) { return e.flicker ? noise_free(*e.flicker) : Value(); }},
        {"flicker_reference_noise",
         [](const ChangeErrors& e) { return e.flicker ? reference_noise(*e.flicker) : Value(); }},
        {"seen_before", [](const ChangeErrors& e) { return e.flicker ? Value(e.flicker->seen) : Value(); }},
    };
    return metrics;
}

const std::vector<Metric<Flicker>>& sequence_metrics() {
    static const std::vector<Metric<Flicker>> metrics = {
        {"flicker", [](const Flicker& f) { return std::optional(f.error); }},
        {"flicker_noise_free", noise_free<Flicker>},
        {"flicker_reference_noise", reference_noise<Flicker>},
        {"seen_before", [](const Flicker& f) { return std::optional(f.seen); }},
    };
    return metrics;
}

// All changes together; no layers where the motion of some is not known.
struct ComparedSequence {
    std::vector<std::pair<std::string, Flicker>> layers;
};

ComparedSequence sequence_of(const std::vector<ComparedChange>& changes) {
    ComparedSequence sequence;
    if (changes.size() < 2)
        return sequence;
    for (const auto& [layer, first] : changes.front().layers) {
        FlickerSums sums;
        std::size_t known = 0;
        for (const ComparedChange& change : changes)
            for (const auto& [name, errors] : change.layers)
                if (name == layer && errors.flicker) {
                    sums.add(errors.flicker->sums);
                    ++known;
                }
        if (known == changes.size())
            sequence.layers.emplace_back(layer, flicker_of(sums, first.halves.has_value()));
    }
    return sequence;
}

bool is_below_noise(const Flicker& f) {
    return f.halves && below_noise(f.error, f.halves->reference_noise);
}

bool is_below_noise(const Comparison& c) {
    return c.halves && below_noise(c.differences.rrmse, c.halves->reference_noise);
}

bool is_below_noise(const ChangeErrors& e) {
    return e.halves && below_noise(e.error, e.halves->reference_noise);
}

std::string shown_frame(const std::optional<int>& frame) {
    return frame ? fmt::format("{}", *frame) : "-";
}

std::string location(const ComparedFrame& frame, const std::string& layer) {
    return frame.frame ? fmt::format("{} of frame {}", shown_layer(layer), *frame.frame) : shown_layer(layer);
}

std::string location(const ComparedChange& change, const std::string& layer) {
    return fmt::format("{} from frame {} to {}", shown_layer(layer), change.from, change.to);
}

// Adds a line for every value of one metric that does not pass.
template <class Result, class Part>
void add_failures(const std::vector<Part>& parts, const Metric<Result>& metric, double limit,
                  std::vector<std::string>& lines) {
    for (const Part& part : parts) {
        for (const auto& [layer, result] : part.layers) {
            const std::optional<double> value = metric.of(result);
            if (!value)
                continue;
            const NotFinite& bad = result.not_finite;
            if (!(std::abs(*value) <= limit))
                lines.push_back(
                    fmt::format("{} of {} is {:.6g}, above {:g}", metric.name, location(part, layer), *value, limit));
            else if (bad.image + bad.reference > 0)
                lines.push_back(fmt::format("{} of {} leaves out {} pixels that are not finite", metric.name,
                                            location(part, layer), bad.image + bad.reference));
        }
    }
}

template <class Result, class Part>
std::vector<Metric<Result>> computed(const std::vector<Metric<Result>>& metrics, const std::vector<Part>& parts) {
    std::vector<Metric<Result>> result;
    for (const Metric<Result>& metric : metrics)
        if (std::any_of(parts.begin(), parts.end(), [&](const Part& part) {
                return std::any_of(part.layers.begin(), part.layers.end(),
                                   [&](const auto& layer) { return metric.of(layer.second).has_value(); });
            }))
            result.push_back(metric);
    return result;
}

template <class Result>
std::vector<std::string> numbers(const Result& result, const std::vector<Metric<Result>>& metrics) {
    std::vector<std::string> cells;
    for (std::size_t m = 0; m < metrics.size(); ++m) {
        const std::optional<double> value = metrics[m].of(result);
        // Only the first metric includes the noise of the reference.
        const char* const mark = m == 0 && is_below_noise(result) ? "*" : "";
        cells.push_back(fmt::format("{}{:.4g}", mark, value.value_or(NAN)));
    }
    return cells;
}

template <class Result, class Part, class Name>
std::string metric_table(const std::vector<Part>& parts, const std::vector<Metric<Result>>& all, const Name& name,
                         const std::string& heading) {
    const std::vector<Metric<Result>> metrics = computed(all, parts);
    std::vector<std::vector<std::string>> rows = {{heading, "layer"}};
    for (const Metric<Result>& metric : metrics)
        rows.front().emplace_back(metric.name);
    for (const Part& part : parts) {
        for (const auto& [layer, result] : part.layers) {
            rows.push_back({name(part), shown_layer(layer)});
            const std::vector<std::string> cells = numbers(result, metrics);
            rows.back().insert(rows.back().end(), cells.begin(), cells.end());
        }
    }
    return text_table(rows, 2);
}

std::string heading(const ComparedFrame& frame) {
    std::string text = "image      " + frame.image.string();
    if (frame.render_seconds)
        text += fmt::format(", rendered in {:.4g} s", *frame.render_seconds);
    text += "\nreference  " + frame.references.front().string();
    if (frame.references.size() > 1)
        text += " and " + frame.references.back().string() + ", two halves";
    return text + "\n";
}

std::string not_finite_lines(const CompareReport& report) {
    std::string text;
    for (const ComparedFrame& frame : report.frames)
        for (const auto& [layer, comparison] : frame.layers)
            if (const NotFinite& bad = comparison.not_finite; bad.image + bad.reference > 0)
                text += fmt::format(
                    "NOT FINITE: {} pixels of the image and {} of the reference in {}: wholly different to flip, left "
                    "out of the other measures\n",
                    bad.image, bad.reference, location(frame, layer));
    return text;
}

std::string noise_line(const CompareReport& report) {
    const auto any = [](const auto& parts) {
        for (const auto& part : parts)
            for (const auto& [layer, result] : part.layers)
                if (is_below_noise(result))
                    return true;
        return false;
    };
    if (!any(report.frames) && !any(report.changes))
        return "";
    return fmt::format("* below {:g} times the reference's noise, which it includes; noise_free does not\n",
                       kNoiseMargin);
}

std::string constants_lines(const CompareReport& report) {
    std::string text = fmt::format(
        "relmse, mape: epsilon = {:g} of the reference's mean; relmse without the worst {:g} % of pixels; "
        "mean: relative, with sign\nflip: mean HDR-FLIP at {:g} pixels per degree",
        kEpsilonShare, 100.0 * kTrimmedShare, report.pixels_per_degree);
    if (report.frames.size() == 1 && report.frames.front().layers.size() == 1) {
        const Exposures& e = report.frames.front().layers.front().second.flip.exposures;
        text += fmt::format(", {} exposures from {:+.2f} to {:+.2f} stops", e.count, e.start, e.stop);
    }
    return text + "\n";
}

template <class Result>
void add_numbers(Json& json, const Result& result, const std::vector<Metric<Result>>& metrics) {
    for (const Metric<Result>& metric : metrics)
        if (const std::optional<double> value = metric.of(result))
            json[metric.name] = *value;  // written as null where it is infinite
    if (result.halves)
        json["below_noise"] = is_below_noise(result);
    json["not_finite_pixels"] = {{"image", result.not_finite.image}, {"reference", result.not_finite.reference}};
}

Json layer_json(const std::string& layer, const Comparison& comparison) {
    Json json = {{"layer", shown_layer(layer)}};
    add_numbers(json, comparison, still_metrics());
    json["epsilon"] = comparison.differences.epsilon;
    json["trimmed_pixels"] = comparison.differences.trimmed;
    const Exposures& e = comparison.flip.exposures;
    json["flip_exposures"] = {{"start_stops", e.start}, {"stop_stops", e.stop}, {"count", e.count}};
    return json;
}

Json frame_json(const ComparedFrame& frame) {
    Json json = {{"frame", frame.frame ? Json(*frame.frame) : Json(nullptr)}, {"image", frame.image.string()}};
    for (const std::filesystem::path& reference : frame.references)
        json["references"].push_back(reference.string());
    json["render_seconds"] = frame.render_seconds ? Json(*frame.render_seconds) : Json(nullptr);
    for (const auto& [layer, comparison] : frame.layers)
        json["layers"].push_back(layer_json(layer, comparison));
    return json;
}

Json change_json(const ComparedChange& change) {
    Json json = {{"from", change.from}, {"to", change.to}};
    for (const auto& [layer, error] : change.layers) {
        json["layers"].push_back({{"layer", shown_layer(layer)}});
        add_numbers(json["layers"].back(), error, change_metrics());
    }
    return json;
}

}  // namespace

std::vector<std::string> metric_names() {
    std::vector<std::string> names;
    for (const auto& metric : still_metrics())
        names.emplace_back(metric.name);
    for (const auto& metric : change_metrics())
        names.emplace_back(metric.name);
    std::erase(names, "seen_before");  // a share, not an error
    return names;
}

Limit parse_limit(const std::string& text, bool halves, bool several_frames) {
    const auto reject = [&](const std::string& why) {
        throw Error(ExitCode::Usage, fmt::format("--fail-above {}: {}", text, why));
    };
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
        reject("expected METRIC=VALUE, e.g. rrmse=0.02");
    Limit limit{text.substr(0, equals)};
    const std::vector<std::string> names = metric_names();
    if (std::find(names.begin(), names.end(), limit.metric) == names.end())
        reject(fmt::format("there is no measure {}; there are {}", limit.metric, fmt::join(names, ", ")));
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + equals + 1, end, limit.value);
    if (error != std::errc() || rest != end || !(limit.value >= 0.0))
        reject("the value must be a number of at least 0");
    if (!several_frames && (limit.metric.starts_with("temporal") || limit.metric.starts_with("flicker")))
        reject("only several frames have a temporal error");
    if (!halves && (limit.metric.ends_with("noise_free") || limit.metric.ends_with("reference_noise")))
        reject("two references, independent halves, are needed");
    return limit;
}

std::vector<std::string> exceeded_limits(const CompareReport& report, const std::vector<Limit>& limits) {
    std::vector<std::string> lines;
    for (const Limit& limit : limits) {
        for (const auto& metric : still_metrics())
            if (limit.metric == metric.name)
                add_failures(report.frames, metric, limit.value, lines);
        for (const auto& metric : change_metrics())
            if (limit.metric == metric.name)
                add_failures(report.changes, metric, limit.value, lines);
    }
    return lines;
}

std::string shown_layer(const std::string& layer) {
    return layer.empty() ? "beauty" : layer;
}

std::string report_text(const CompareReport& report) {
    std::string text = heading(report.frames.front());
    if (report.frames.size() > 1)
        text += fmt::format("... and {} more frames\n", report.frames.size() - 1);
    const auto frame_of = [](const ComparedFrame& f) { return shown_frame(f.frame); };
    const auto frames_of = [](const ComparedChange& c) { return fmt::format("{}-{}", c.from, c.to); };
    text.append("\n").append(metric_table(report.frames, still_metrics(), frame_of, "frame"));
    if (!report.changes.empty())
        text.append("\n").append(metric_table(report.changes, change_metrics(), frames_of, "frames"));
    if (const ComparedSequence all = sequence_of(report.changes); !all.layers.empty())
        text.append("\n").append(metric_table(
            std::vector{all}, sequence_metrics(), [](const ComparedSequence&) { return std::string("all"); },
            "frames"));
    if (!report.spectra.empty())
        text.append("\n").append(spectrum_table(report.spectra));
    return text + "\n" + not_finite_lines(report) + noise_line(report) + constants_lines(report);
}

std::string report_json(const CompareReport& report, const std::vector<std::string>& exceeded) {
    Json json = {{"schema_version", 1},
                 {"constants",
                  {{"epsilon_share_of_mean", kEpsilonShare},
                   {"trimmed_share", kTrimmedShare},
                   {"noise_margin", kNoiseMargin},
                   {"pixels_per_degree", report.pixels_per_degree}}},
                 {"overruled_differences", report.overruled},
                 {"frames", Json::array()},
                 {"changes", Json::array()},
                 {"exceeded", exceeded}};
    for (const ComparedFrame& frame : report.frames)
        json["frames"].push_back(frame_json(frame));
    for (const ComparedChange& change : report.changes)
        json["changes"].push_back(change_json(change));
    for (const auto& [layer, flicker] : sequence_of(report.changes).layers) {
        json["sequence"].push_back({{"layer", shown_layer(layer)}});
        add_numbers(json["sequence"].back(), flicker, sequence_metrics());
    }
    for (const auto& [layer, spectrum] : report.spectra) {
        Json entry = {{"layer", shown_layer(layer)}};
        entry.update(to_json(spectrum));
        json["spectra"].push_back(entry);
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace brisance
