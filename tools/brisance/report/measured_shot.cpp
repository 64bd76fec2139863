#include "measured_shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "camera/camera.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "film_strip.h"
#include "forecast/plan.h"
#include "load_shot.h"
#include "measure_runs.h"
#include "reference.h"
#include "render/input/frame_input.h"
#include "shot/write_shot.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

constexpr int kLeastReferenceSamples = 1024;
constexpr int kReferenceOverBudget = 4;  // times the paths of the largest run

FrameFile only_frame(const Shot& shot, const ReportOptions& options) {
    const std::vector<FrameFile> frames =
        resolve_frames(shot, options.frame.empty() ? std::nullopt : std::optional(parse_frames(options.frame)));
    if (frames.size() == 1)
        return frames.front();
    std::vector<int> numbers;
    numbers.reserve(frames.size());
    for (const FrameFile& frame : frames)
        numbers.push_back(frame.frame);
    throw Error(ExitCode::Usage, fmt::format("a report covers one frame, and there are {}: choose one with -f",
                                             describe_frames(numbers)));
}

// A camera that is the same for every run, whatever its picture's width.
void fix_camera(Shot& shot, const FrameInput& input) {
    shot.camera = input.camera;
    shot.camera_given = true;
}

int largest_budget(const std::vector<PlannedMethod>& methods) {
    int most = 0;
    for (const PlannedMethod& method : methods)
        for (const PlannedRun& run : method.runs)
            if (run.shot.method == RenderMethod::Path)
                most = std::max(most, run.shot.tracing.samples);
    return most;
}

// A run with the seed of the reference would share its first paths.
int seed_of_reference(const std::vector<PlannedMethod>& methods) {
    std::set<int> taken;
    for (const PlannedMethod& method : methods)
        for (const PlannedRun& run : method.runs)
            if (run.shot.method == RenderMethod::Path)
                taken.insert(run.shot.tracing.seed);
    return free_seed(taken);
}

std::vector<std::string> reference_settings(const ReportOptions& options, const std::vector<PlannedMethod>& methods) {
    int samples = options.reference_samples;
    if (samples == 0 && options.reference_seconds == 0.0)
        samples = std::max(kLeastReferenceSamples, kReferenceOverBudget * largest_budget(methods));
    return {"method=path",
            fmt::format("tracing.seed={}", seed_of_reference(methods)),
            samples > 0 ? fmt::format("tracing.samples={}", samples) : "tracing.samples=none",
            options.reference_seconds > 0.0 ? fmt::format("tracing.seconds={}", options.reference_seconds)
                                            : "tracing.seconds=none",
            "tracing.error=none",
            "tracing.denoising_radius=0",
            "output.layers.cells=true",
            "output.halves=true"};
}

// The command that renders with `settings` over the given shot.
std::string render_command(const ReportOptions& options, const std::vector<std::string>& settings,
                           const std::string& output) {
    std::vector<std::string> words = {"brisance", "render", options.input};
    if (!options.frame.empty())
        words.insert(words.end(), {"-f", options.frame});
    if (!options.preset.empty())
        words.insert(words.end(), {"--preset", options.preset});
    for (const std::vector<std::string>* list : {&options.overrides, &settings})
        for (const std::string& setting : *list)
            words.insert(words.end(), {"--set", setting});
    if (options.threads > 0)
        words.insert(words.end(), {"--threads", std::to_string(options.threads)});
    words.insert(words.end(), {"-o", output});
    std::string line;
    for (const std::string& word : words)
        line += fmt::format("{}{}", line.empty() ? "" : " ", shell_quoted(word));
    return line;
}

void add_commands(const ReportOptions& options, Report& report) {
    for (MethodResult& result : report.methods)
        for (MeasuredRun& run : result.runs)
            run.command = render_command(options, run.settings, run.id + ".exr");
}

Report begin_report(const ReportOptions& options, const Shot& shot, const FrameFile& frame) {
    Report report;
    report.version = BRISANCE_VERSION;
    report.date = report_date();
    for (const std::string& word : options.command_line)
        report.command += fmt::format("{}{}", report.command.empty() ? "" : " ", shell_quoted(word));
    report.shot = {shot.name.empty() ? fs::path(options.input).stem().string() : shot.name,
                   options.input,
                   frame.file.filename().string(),
                   frame.frame,
                   shot.camera.width,
                   shot.camera.height,
                   settings_hash(shot),
                   to_json(shot)};
    report.machine = this_machine();
    report.repeats = options.repeats;
    return report;
}

ReportReference make_reference(const ReportOptions& options, const std::vector<PlannedMethod>& methods,
                               const Shot& shot, const FrameInput& input, Progress& progress) {
    const std::vector<std::string> settings = reference_settings(options, methods);
    ReportReference reference = trace_reference(shot_with(shot, "reference", settings), input, progress);
    reference.summary.command = render_command(options, settings, "reference.exr");
    return reference;
}

// Of the page's pictures, so that all are shown alike.
double base_exposure(const Shot& shot, const ReportReference& reference) {
    if (shot.exposure_given)
        return shot.output.exposure_stops;
    return exposure_for(mean_picture(reference.layers.at("")));
}

PagePictures begin_pictures(const ReportOptions& options, const Shot& shot, const ReportReference& reference) {
    PagePictures pictures({options.picture_width, options.exposures, base_exposure(shot, reference), shot.output.view});
    for (const auto& [layer, target] : reference.layers)
        pictures.add_picture("reference", layer, mean_picture(target));
    return pictures;
}

// Only those that own a cell which the shot needs, and run.
std::vector<PlannedMethod> plan_owners(const Shot& shot, const FrameInput& input, const std::vector<Method>& methods,
                                       const std::set<int>& taken, Report& report) {
    const Plan plan = plan_cells(shot, input.medium, input.surroundings.get());
    const std::vector<Method> owners = owners_of(methods, plan.needed);
    if (owners.empty())
        throw Error(ExitCode::BadData, "no method owns a cell of this shot that holds light");
    return plan_what_can_run(shot, owners, taken, report);
}

// [m]; 0 without a volume.
double voxel_of(const Medium& medium) {
    return medium.lattice.brick_count() > 0 ? double(medium.spacing) : 0.0;
}

}  // namespace

OpenedShot open_shot(const ReportOptions& options, Progress& progress) {
    OpenedShot opened{load_shot(options.input, {options.preset, options.overrides}, progress), {}};
    opened.frame = only_frame(opened.shot, options);
    return opened;
}

MeasuredShot measure_shot(const ReportOptions& options, const OpenedShot& opened, const std::vector<Method>& methods,
                          Comparing comparing, Progress& progress) {
    Shot shot = opened.shot;
    const bool owners = comparing == Comparing::Owners;
    if (!owners)
        plan_runs(shot, methods);  // reports errors before anything is read
    Report report = begin_report(options, shot, opened.frame);
    std::optional<ReportReference> reference;
    if (!options.references.empty())
        reference = read_reference({options.references.begin(), options.references.end()}, shot, opened.frame.frame);

    const Stopwatch watch;
    Statistics loading;
    std::optional<FrameInput> input = load_frame(shot, opened.frame.file, opened.frame.frame, loading, progress);
    report.loading_seconds = watch.seconds();
    fix_camera(shot, *input);
    const std::set<int> taken = reference ? reference->seeds : std::set<int>();
    const std::vector<PlannedMethod> planned =
        owners ? plan_owners(shot, *input, methods, taken, report) : plan_runs(shot, methods, taken);
    if (!reference)
        reference = make_reference(options, planned, shot, *input, progress);
    report.reference = reference->summary;
    for (const std::string& layer : report_layers())
        if (reference->layers.contains(layer))
            report.layers.push_back(layer);
    PagePictures pictures = begin_pictures(options, shot, *reference);
    FilmStrips strips;
    const int strip_frames = options.strip_frames.value_or(0);
    measure_runs(planned, *input, *reference, {options.repeats, owners, owners, strip_frames > 0 ? &strips : nullptr},
                 report, pictures, progress);
    if (report.methods.empty())
        throw Error(ExitCode::RenderFailed, report.failures.empty()
                                                ? std::string("no method was measured")
                                                : fmt::format("every method failed; {}: {}", report.failures[0].method,
                                                              report.failures[0].reason));
    if (strip_frames > 0) {
        const StripRequest request{strip_frames, voxel_of(input->medium), opened.frame};
        input.reset();  // two of them would need twice the memory
        measure_strips(request, shot, planned, *reference, strips, report, pictures, progress);
    }
    add_commands(options, report);
    return {std::move(report), std::move(pictures)};
}

}  // namespace brisance
