#include "measure_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "core/error.h"
#include "film_strip.h"
#include "methods.h"
#include "metrics/layers.h"
#include "named_progress.h"
#include "render/render_frame.h"
#include "render_cost.h"
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

struct Rendered {
    RenderedFrame frame;
    Cost cost;
};

Rendered render_repeatedly(const Shot& given, const FrameInput& input, int repeats, Progress& progress) {
    Rendered result;
    Shot shot = given;
    shot.certify.belief = 0.0;  // its samples would count as the method's time
    std::vector<Cost> costs;
    for (int i = 0; i < repeats; ++i) {
        const CostMeter meter;
        result.frame = render_medium(shot, input.medium, progress, input.surroundings.get());
        costs.push_back(meter.cost());
    }
    const auto middle = costs.begin() + static_cast<std::ptrdiff_t>((costs.size() - 1) / 2);
    std::nth_element(costs.begin(), middle, costs.end(),
                     [](const Cost& a, const Cost& b) { return a.wall_seconds < b.wall_seconds; });
    result.cost = *middle;
    return result;
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

// Errors of all layers; of those that `shows` accepts also pictures.
template <class Shows>
void compare_layers(const Image& image, const ReportReference& reference, const Shows& shows, MeasuredRun& run,
                    PagePictures& pictures) {
    const std::vector<std::string> there = picture_layers(image);
    for (const auto& [layer, target] : reference.layers) {
        if (std::find(there.begin(), there.end(), layer) == there.end())
            continue;
        const Picture picture = picture_of(image, {layer}).picture;
        const Comparison comparison = compare(picture, target);
        const auto noise = reference.summary.noise.find(layer);
        run.errors[layer] =
            errors_of(comparison, noise == reference.summary.noise.end() ? std::nullopt : std::optional(noise->second));
        if (!shows(layer))
            continue;
        pictures.add_picture(run.id, layer, picture);
        pictures.add_errors(run.id, layer, picture, mean_picture(target), comparison.differences.epsilon,
                            comparison.flip.errors);
    }
}

struct RunNumber {
    std::size_t method, step;  // from 0
};

MeasuredRun measure_run(const PlannedMethod& planned, RunNumber number, const FrameInput& input,
                        const ReportReference& reference, const MeasureOptions& options, PagePictures& pictures,
                        Progress& progress) {
    const PlannedRun& step = planned.runs[number.step];
    NamedProgress named(progress, fmt::format("{}, {}", planned.method.label, step.step.label));
    Rendered rendered = render_repeatedly(step.shot, input, options.repeats, named);
    MeasuredRun run;
    run.id = fmt::format("method{}step{}", number.method + 1, number.step + 1);
    run.step = step.step;
    run.settings = step.settings;
    run.cost = rendered.cost;
    run.samples_per_pixel = rendered.frame.metadata.samples_per_pixel;
    run.statistics = std::move(rendered.frame.statistics);
    named.stage("measuring");
    const bool last = number.step + 1 == planned.runs.size();
    const auto shows = [&](const std::string& layer) {
        return !options.few_pictures || (last && (layer.empty() || owns(planned.method, layer)));
    };
    compare_layers(rendered.frame.image, reference, shows, run, pictures);
    if (options.strips != nullptr && number.step == 0)
        options.strips->add_frame(planned.method, rendered.frame.image, reference);
    return run;
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
    for (std::size_t m = 0; m < methods.size(); ++m) {
        MethodResult result{methods[m].method, {}};
        for (std::size_t s = 0; s < methods[m].runs.size(); ++s) {
            try {
                result.runs.push_back(measure_run(methods[m], {m, s}, input, reference, options, pictures, progress));
            } catch (const std::exception& error) {
                if (!options.keep_going)
                    throw;
                report.failures.push_back(
                    {result.method.label, fmt::format("{}: {}", methods[m].runs[s].step.label, reason_of(error))});
                break;
            }
        }
        if (!result.runs.empty())
            report.methods.push_back(std::move(result));
    }
}

}  // namespace brisance
