#include "measure_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>

#include "core/content_hash.h"
#include "core/error.h"
#include "film_strip.h"
#include "methods.h"
#include "metrics/layers.h"
#include "named_progress.h"
#include "render/render_frame.h"
#include "render_cost.h"
#include "repeats.h"
#include "shot/read_shot.h"
#include "shot/scene_differences.h"
#include "shot/write_shot.h"

namespace brisance {
namespace {

// The step alone says when a run stops, cells are what is compared, and pictures of lights would cost time. Lamps in
// the place of the fire, other solvers of scattering and filtered noise are methods of their own.
void complete(const Shot& shot, std::vector<std::string>& settings) {
    if (sets(settings, "tracing.samples") && shot.tracing.seconds > 0.0 && !sets(settings, "tracing.seconds"))
        settings.push_back("tracing.seconds=none");
    if (sets(settings, "tracing.samples") && shot.tracing.error > 0.0 && !sets(settings, "tracing.error"))
        settings.push_back("tracing.error=none");
    if (shot.lighting.clusters > 0 && !sets(settings, "lighting.clusters"))
        settings.push_back("lighting.clusters=0");
    if (shot.scattering.solver != ScatteringSolver::Hierarchy && !sets(settings, "scattering.solver"))
        settings.push_back("scattering.solver=hierarchy");
    if (shot.tracing.denoising_radius > 0 && !sets(settings, "tracing.denoising_radius"))
        settings.push_back("tracing.denoising_radius=0");
    if (!shot.output.cell_layers)
        settings.push_back("output.layers.cells=true");
    if (shot.output.virtual_lights)
        settings.push_back("output.virtual_lights=false");
    if (shot.output.bound_layers)
        settings.push_back("output.layers.bound=false");
}

PlannedRun plan_run(const Shot& shot, const Method& method, const MethodStep& step, const std::set<int>& taken) {
    PlannedRun run{step, method.settings, {}};
    run.settings.insert(run.settings.end(), step.settings.begin(), step.settings.end());
    complete(shot, run.settings);
    const std::string name = fmt::format("{}, {}", method.label, step.label);
    run.shot = shot_with(shot, name, run.settings);
    if (run.shot.method == RenderMethod::Path && taken.contains(run.shot.tracing.seed)) {
        run.settings.push_back(fmt::format("tracing.seed={}", free_seed(taken)));
        run.shot = shot_with(shot, name, run.settings);
    }
    const std::vector<std::string> changes = scene_differences(to_json(shot), to_json(run.shot));
    if (!changes.empty())
        throw Error(ExitCode::Usage, fmt::format("{}: a method may not change what is to be computed: {}", name,
                                                 fmt::join(changes, "; ")));
    return run;
}

LayerErrors errors_of(const Comparison& comparison, const std::optional<double>& noise) {
    LayerErrors errors;
    errors.differences = comparison.differences;
    errors.flip = comparison.flip.mean;
    errors.not_finite = comparison.not_finite;
    if (comparison.halves)
        errors.noise_free = comparison.halves->noise_free;
    errors.below_noise = noise && below_noise(errors.differences.rrmse, *noise);
    return errors;
}

// What the repeats of one step gave so far.
struct StepRecord {
    MeasuredRun run;  // of the first repeat
    std::vector<Cost> costs;
    std::map<std::string, std::vector<LayerErrors>> errors;  // by layer
    std::map<std::string, std::set<std::string>> pictures;   // hashes of their pixels
};

std::string hash_of(const Picture& picture) {
    return content_hash({reinterpret_cast<const char*>(picture.pixels.data()), picture.pixels.size() * sizeof(Rgb)});
}

// Errors of all layers; of those that `shows` accepts also pictures.
template <class Shows>
void compare_layers(const Image& image, const ReportReference& reference, const Shows& shows, StepRecord& record,
                    PagePictures& pictures) {
    const std::vector<std::string> there = picture_layers(image);
    for (const auto& [layer, target] : reference.layers) {
        if (std::find(there.begin(), there.end(), layer) == there.end())
            continue;
        const Picture picture = picture_of(image, {layer}).picture;
        const Comparison comparison = compare(picture, target);
        const auto noise = reference.summary.noise.find(layer);
        record.errors[layer].push_back(errors_of(
            comparison, noise == reference.summary.noise.end() ? std::nullopt : std::optional(noise->second)));
        record.pictures[layer].insert(hash_of(picture));
        if (!shows(layer))
            continue;
        pictures.add_picture(record.run.id, layer, picture);
        pictures.add_errors(record.run.id, layer, picture, mean_picture(target), comparison.differences.epsilon,
                            comparison.flip.errors);
    }
}

struct RunNumber {
    std::size_t method, step;  // from 0
    int repeat;                // from 0
};

// What all repeats share, but for errors and costs.
MeasuredRun describe_run(const PlannedRun& planned, RunNumber number, RenderedFrame& frame) {
    MeasuredRun run;
    run.id = fmt::format("method{}step{}", number.method + 1, number.step + 1);
    run.step = planned.step;
    run.settings = planned.settings;
    run.samples_per_pixel = frame.metadata.samples_per_pixel;
    run.statistics = std::move(frame.statistics);
    return run;
}

std::string name_of_run(const PlannedMethod& planned, RunNumber number, int repeats) {
    std::string name = fmt::format("{}, {}", planned.method.label, planned.runs[number.step].step.label);
    return repeats > 1 ? fmt::format("{}, {} of {}", name, number.repeat + 1, repeats) : name;
}

// One render of one step.
void measure_repeat(const PlannedMethod& planned, RunNumber number, const FrameInput& input,
                    const ReportReference& reference, const MeasureOptions& options, StepRecord& record,
                    PagePictures& pictures, Progress& progress) {
    NamedProgress named(progress, name_of_run(planned, number, options.repeats));
    const Shot shot =
        by_its_method_alone(shot_of_repeat(planned.runs[number.step].shot, number.repeat, reference.seeds));
    const CostMeter meter;
    RenderedFrame frame = render_medium(shot, input.medium, named, input.surroundings.get());
    record.costs.push_back(meter.cost());
    named.stage("measuring");
    const bool first = number.repeat == 0;
    if (first)
        record.run = describe_run(planned.runs[number.step], number, frame);
    const bool last = number.step + 1 == planned.runs.size();
    const auto shows = [&](const std::string& layer) {
        return first && (!options.few_pictures || (last && (layer.empty() || owns(planned.method, layer))));
    };
    compare_layers(frame.image, reference, shows, record, pictures);
    if (options.strips != nullptr && first && number.step == 0)
        options.strips->add_frame(planned.method, frame.image, reference);
}

MethodResult result_of(const Method& method, std::vector<StepRecord> records) {
    MethodResult result{method, {}};
    for (StepRecord& record : records) {
        record.run.cost = median_cost(record.costs);
        for (const auto& [layer, errors] : record.errors)
            record.run.errors[layer] = mean_errors(errors, record.pictures.at(layer).size() > 1);
        result.runs.push_back(std::move(record.run));
    }
    return result;
}

}  // namespace

std::string reason_of(const std::exception& error) {
    const std::string text = error.what();
    return text.substr(0, text.find('\n'));
}

Shot shot_with(const Shot& shot, const std::string& source, const std::vector<std::string>& settings) {
    Shot result = parse_shot(to_json(shot), source, shot.folder, {"", settings});
    const CameraSettings requested = result.camera;
    result.camera = shot.camera;
    // Of the method, unlike the rest of the camera.
    result.camera.samples_per_axis = requested.samples_per_axis;
    result.camera.edge_refinement = requested.edge_refinement;
    result.camera_given = shot.camera_given;
    return result;
}

int free_seed(const std::set<int>& taken) {
    int seed = 0;
    while (taken.contains(seed))
        ++seed;
    return seed;
}

std::vector<PlannedMethod> plan_runs(const Shot& shot, const std::vector<Method>& methods, const std::set<int>& taken) {
    std::vector<PlannedMethod> planned;
    for (const Method& method : methods) {
        planned.push_back({method, {}});
        for (const MethodStep& step : method.steps)
            planned.back().runs.push_back(plan_run(shot, method, step, taken));
    }
    return planned;
}

std::vector<PlannedMethod> plan_what_can_run(const Shot& shot, const std::vector<Method>& methods,
                                             const std::set<int>& taken, Report& report) {
    std::vector<PlannedMethod> planned;
    for (const Method& method : methods) {
        try {
            planned.push_back(plan_runs(shot, {method}, taken).front());
        } catch (const std::exception& error) {
            report.failures.push_back({method.label, reason_of(error)});
        }
    }
    return planned;
}

void measure_runs(const std::vector<PlannedMethod>& methods, const FrameInput& input, const ReportReference& reference,
                  const MeasureOptions& options, Report& report, PagePictures& pictures, Progress& progress) {
    std::vector<std::vector<StepRecord>> records;
    for (const PlannedMethod& method : methods)
        records.emplace_back(method.runs.size());
    // All steps once before any is rendered again: what else the machine does disturbs all of them alike.
    for (int repeat = 0; repeat < options.repeats; ++repeat)
        for (std::size_t m = 0; m < methods.size(); ++m)
            for (std::size_t s = 0; s < records[m].size(); ++s) {
                try {
                    measure_repeat(methods[m], {m, s, repeat}, input, reference, options, records[m][s], pictures,
                                   progress);
                } catch (const std::exception& error) {
                    if (!options.keep_going)
                        throw;
                    report.failures.push_back({methods[m].method.label,
                                               fmt::format("{}: {}", methods[m].runs[s].step.label, reason_of(error))});
                    records[m].resize(s);
                }
            }
    for (std::size_t m = 0; m < methods.size(); ++m)
        if (!records[m].empty())
            report.methods.push_back(result_of(methods[m].method, std::move(records[m])));
}

}  // namespace brisance
