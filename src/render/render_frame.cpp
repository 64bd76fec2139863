#include "render/render_frame.h"

#include <sys/resource.h>

#include <algorithm>
#include <functional>

#include "camera/camera.h"
#include "certificate/certify.h"
#include "core/cpu_clock.h"
#include "core/stopwatch.h"
#include "forecast/correction_plan.h"
#include "forecast/machine_speed.h"
#include "forecast/plan.h"
#include "reference/trace_picture.h"
#include "render/believe.h"
#include "render/bound_layers.h"
#include "render/checkpoint_key.h"
#include "render/choice/choose_method.h"
#include "render/choice/time_budget.h"
#include "render/correct_frame.h"
#include "render/draw.h"
#include "render/input/frame_input.h"
#include "render/input/kept_inputs.h"
#include "render/light_windows.h"
#include "render/shutter/open_shutter.h"

namespace brisance {

namespace {

// Passes everything on and keeps notices and warnings for the statistics.
class Recorder : public Progress {
public:
    Recorder(Progress& to, Statistics& statistics) : to_(to), statistics_(statistics) {}
    void stage(const std::string& name) override { to_.stage(name); }
    void fraction(double done) override { to_.fraction(done); }
    void notice(const std::string& line) override {
        statistics_.notices.push_back(line);
        to_.notice(line);
    }
    void warning(const std::string& code, const std::string& line) override {
        statistics_.warnings.push_back(code + ": " + line);
        to_.warning(code, line);
    }

private:
    Progress& to_;
    Statistics& statistics_;
};

std::uint64_t peak_resident_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;
}

std::string joined(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : "+") + name;
    return all;
}

Belief add_belief(RenderedFrame& out, const DrawInput& input, const Shot& asked, const Correction& correction,
                  Progress& progress) {
    StageCost cost;
    Belief belief = believe(out, input, asked, correction, cost, progress);
    out.statistics.stages.push_back(std::move(cost));
    return belief;
}

Certificate add_certificate(RenderedFrame& out, const DrawInput& input, const Belief& belief, Progress& progress) {
    const Stopwatch watch;
    const double cpu = process_cpu_seconds();
    Certificate certificate = certify(out.image, certified_scene(input), input.shot.certify, progress);
    out.statistics.certificate = certificate.to_json();
    out.statistics.stages.push_back({"certificate",
                                     watch.seconds(),
                                     0,
                                     {{"samples", certificate.samples}, {"cpu_seconds", process_cpu_seconds() - cpu}}});
    out.metadata.text["brisance/certificate"] = certificate.to_json().dump();
    const std::string ratios = belief.ratios(certificate);
    progress.notice("certificate: " + certificate.line() + (ratios.empty() ? "" : "; " + ratios));
    return certificate;
}

// What is believed of the picture's error, and what is certified of it if the shot asks for that.
void add_errors(RenderedFrame& out, const DrawInput& input, const Shot& asked, const Correction& correction,
                Progress& progress) {
    const Belief belief = add_belief(out, input, asked, correction, progress);
    std::optional<Certificate> certificate;
    if (input.shot.certify.enabled)
        certificate = add_certificate(out, input, belief, progress);
    out.statistics.believed_error = belief.to_json(certificate ? &*certificate : nullptr);
    out.metadata.text["brisance/believed_error"] = out.statistics.believed_error.dump();
}

void trace_into(RenderedFrame& out, const DrawInput& input, const Checkpoint& checkpoint, Progress& progress) {
    const TracedScene scene{
        input.medium,      input.camera,      input.surroundings, input.shot.tracing, input.shot.scattering.bounces,
        input.plan.needed, input.shot.output, input.moments()};
    TracedPicture traced = trace_picture(scene, checkpoint, out.statistics, progress);
    out.image = std::move(traced.image);
    out.halves = {std::move(traced.halves[0]), std::move(traced.halves[1])};
    out.metadata.samples_per_pixel = traced.samples_per_pixel;
}

void draw_into(RenderedFrame& out, const DrawInput& input, Progress& progress) {
    Drawn drawn = draw_by_many_lights(input, out.statistics, progress);
    out.image = std::move(drawn.image);
    out.light_pictures = std::move(drawn.light_pictures);
    out.metadata.samples_per_pixel = drawn.samples_per_pixel;
}

// Draws by many lights and corrects. That needs layers of cells, which are taken off where the shot wants none.
Correction draw_and_correct(RenderedFrame& out, const DrawInput& input, const Shot& asked, Progress& progress) {
    if (!may_be_corrected(asked, input.plan)) {
        draw_into(out, input, progress);
        return {};
    }
    Shot with_cells = input.shot;
    with_cells.output.cell_layers = true;
    draw_into(out,
              {with_cells, input.plan, input.medium, input.surroundings, input.camera, input.shutter,
               input.light_positions, input.time},
              progress);
    Correction correction = correct_frame(out, input, asked, progress);
    if (!input.shot.output.cell_layers)
        std::erase_if(out.image.layers,
                      [](const Layer& layer) { return std::ranges::find(kCellNames, layer.name) != kCellNames.end(); });
    return correction;
}

// Resolves method=auto for this frame alone.
Shot with_chosen_method(const Shot& shot, const Medium& medium, const Surroundings* surroundings,
                        const CameraSettings& camera, RenderedFrame& out, Progress& progress) {
    if (shot.method != RenderMethod::Automatic)
        return shot;
    const MethodForecast forecast = forecast_methods(shot, medium, surroundings, camera, progress);
    out.statistics.stages.push_back(forecast.cost);
    out.metadata.text["brisance/method"] = forecast.name();
    return with_method(shot, forecast);
}

// Parts of a frame's input, by reference.
struct FrameView {
    const Medium& medium;
    const Surroundings* surroundings;
    const CameraSettings& camera;
    const Animation& animation;
    std::optional<CameraTime> time = std::nullopt;  // none: the camera takes the samples of its settings
};

// A black picture of something that is there wants a word.
void warn_of_darkness(const Medium& medium, const Surroundings* surroundings, Progress& progress) {
    if (medium.emits() || (surroundings && !surroundings->emitters().empty()))
        return;
    if (!medium.lattice.empty() || (surroundings && surroundings->scene().triangle_count() > 0))
        progress.warning("nothing-shines",
                         "there is no fire and no light, the picture is black: add scene.lights, or let a first look "
                         "choose them with --look auto");
}

// Where virtual lights lie, for a plan that needs them; none: the frame places its own.
using PositionsFor = std::function<std::vector<SharedPositions>(const Shot&, Progress&)>;

void add_plan(const Plan& plan, Statistics& statistics) {
    statistics.cells = plan.cells();
    statistics.skipped = plan.skipped;
    if (!plan.choice_cost.name.empty())
        statistics.stages.push_back(plan.choice_cost);
}

bool needs_virtual_lights(const Plan& plan) {
    return plan.needs(Cell::SS) || plan.needs(Cell::MS);
}

void render_into(RenderedFrame& out, const Shot& given, const FrameView& frame, const Checkpoint& checkpoint,
                 const PositionsFor& positions_for, Progress& progress) {
    const Medium& medium = frame.medium;
    const Surroundings* const surroundings = frame.surroundings;
    const Shot asked = with_chosen_method(given, medium, surroundings, frame.camera, out, progress);
    const Plan plan = plan_cells(asked, medium, surroundings);
    const Shot shot =
        asked.method == RenderMethod::Path ? asked : shot_of_lights(asked, plan, {medium, surroundings, frame.camera});
    add_plan(plan, out.statistics);
    warn_of_darkness(medium, surroundings, progress);
    const Camera camera(frame.camera, medium);
    const OpenShutter shutter(shot.shutter, medium, surroundings, frame.camera, frame.animation, progress);
    std::vector<SharedPositions> positions;
    if (positions_for && needs_virtual_lights(plan))
        positions = positions_for(shot, progress);
    const DrawInput input{shot,      plan,
                          medium,    surroundings,
                          camera,    shutter.still() ? nullptr : &shutter,
                          positions, frame.time ? &*frame.time : nullptr};
    if (frame.time && !shutter.still())
        progress.warning("seconds", "things move while the shutter is open: the shot's own samples stay");
    if (shot.output.virtual_lights)
        if (const std::optional<std::string> reason = why_no_virtual_lights(shot, plan))
            progress.warning("virtual-lights", kNoLightPictures + *reason);
    check_bound_layers(shot, plan, progress);
    Correction correction;
    if (shot.method == RenderMethod::Path)
        trace_into(out, input, checkpoint, progress);
    else
        correction = draw_and_correct(out, input, asked, progress);
    add_errors(out, input, asked, correction, progress);
    out.metadata.camera_from_world = camera.camera_from_world();
    out.metadata.vertical_fov_degrees = frame.camera.vertical_fov_degrees;
    out.metadata.text["brisance/cells"] = joined(plan.cells());
    out.statistics.peak_resident_bytes = peak_resident_bytes();
}

struct TimedShot {
    Shot shot;
    std::optional<CameraTime> time;
};

// Resolves the shot's time for this frame alone. Some settings are the camera's. `watch`: of the frame.
TimedShot with_time(const Shot& shot, const Medium& medium, const Surroundings* surroundings, CameraSettings& camera,
                    const Stopwatch& watch, RenderedFrame& out, Progress& progress) {
    if (!(shot.seconds > 0.0))
        return {shot, std::nullopt};
    const double speed = machine_speed();
    TimedSettings timed =
        settings_for_time(shot, medium, surroundings, camera, {shot.seconds, watch.seconds(), speed}, progress);
    camera.samples_per_axis = timed.shot.camera.samples_per_axis;
    camera.edge_refinement = timed.shot.camera.edge_refinement;
    out.statistics.stages.push_back(std::move(timed.cost));
    if (!timed.camera_end)
        return {timed.shot, std::nullopt};
    return {timed.shot, CameraTime{watch, *timed.camera_end}};
}

// Seconds in all; what no stage reports is a stage, too.
void finish(RenderedFrame& out, double seconds) {
    double reported = 0.0;
    for (const StageCost& stage : out.statistics.stages)
        reported += stage.seconds;
    if (seconds > reported)
        out.statistics.stages.push_back({"between the stages", seconds - reported, 0, {}});
    out.statistics.seconds = out.metadata.render_seconds = seconds;
}

}  // namespace

RenderedFrame render_frame(const Shot& given, const std::filesystem::path& volume, int frame, Progress& to,
                           const std::filesystem::path& checkpoint, KeptInputs* kept) {
    const Stopwatch watch;
    RenderedFrame out;
    Recorder progress(to, out.statistics);
    FrameInput input = load_frame(given, volume, frame, out.statistics, progress, kept);
    if (kept)
        read_next_frame(given, input.medium, *kept);
    const auto [shot, time] =
        with_time(given, input.medium, input.surroundings.get(), input.camera, watch, out, progress);
    const auto positions_for = [&](const Shot& chosen, Progress& said) {
        return shared_positions(chosen, frame, input, kept, out.statistics, said);
    };
    render_into(out, shot, {input.medium, input.surroundings.get(), input.camera, input.animation, time},
                {checkpoint, checkpoint_key(shot, volume, frame)}, positions_for, progress);
    out.metadata.frame = frame;
    finish(out, watch.seconds());
    return out;
}

RenderedFrame render_medium(const Shot& given, const Medium& medium, Progress& to, const Surroundings* surroundings) {
    const Stopwatch watch;
    RenderedFrame out;
    Recorder progress(to, out.statistics);
    CameraSettings camera = given.camera_given ? given.camera : framed_camera(medium, given.camera);
    const auto [shot, time] = with_time(given, medium, surroundings, camera, watch, out, progress);
    render_into(out, shot, {medium, surroundings, camera, {}, time}, {}, {}, progress);
    finish(out, watch.seconds());
    return out;
}

Statistics plan_frame(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& to) {
    const Stopwatch watch;
    Statistics statistics;
    Recorder progress(to, statistics);
    FrameInput input = load_frame(shot, volume, frame, statistics, progress);
    RenderedFrame unused;
    Shot chosen = with_time(shot, input.medium, input.surroundings.get(), input.camera, watch, unused, progress).shot;
    if (chosen.method == RenderMethod::Automatic)
        chosen = with_method(chosen,
                             forecast_methods(chosen, input.medium, input.surroundings.get(), input.camera, progress));
    add_plan(plan_cells(chosen, input.medium, input.surroundings.get()), statistics);
    return statistics;
}

}  // namespace brisance
