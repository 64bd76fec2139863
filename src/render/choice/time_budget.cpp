#include "render/choice/time_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "camera/camera.h"
#include "core/stopwatch.h"
#include "forecast/correction_plan.h"
#include "forecast/expected_errors.h"
#include "forecast/machine_speed.h"
#include "render/choice/camera_time.h"
#include "render/input/frame_input.h"
#include "render/many_lights.h"

namespace brisance {

namespace {

// From coarse to fine. The finest are followed by a correction (correction/correct.h), and are by lights alone without.
struct Step {
    float error, alpha, scattering_alpha;
    float lattice_error;
    // Seconds of samples over those of the picture, at least and at most.
    double least_correction = 0.0, most_correction = 0.0;
};
constexpr std::array<Step, 5> kGridSteps = {{{0.1f, 1.0f, 1.0f, 0.1f},
                                             {0.05f, 1.0f, 1.0f, 0.05f},
                                             {0.03f, 1.5f, 1.25f, 0.04f},
                                             {0.02f, 2.0f, 1.5f, 0.03f, 0.2, 20.0},
                                             {0.01f, 3.0f, 2.0f, 0.015f, 1.5, 20.0}}};

// Forecasts of the lighting grid are up to 30 % too low (docs/numbers.md).
constexpr double kMargin = 1.3;
// Of the path tracer they matter for its set-up and its last pass only.
constexpr double kPathMargin = 1.1;
// The error falls about as this power of the time while a correction takes more of it (docs/numbers.md).
constexpr double kCorrected = 0.45;
// What lights of a set may take of the time, by a forecast that may err by a factor of three; and their finest step.
constexpr double kLightsOfSet = 0.3;
constexpr int kFinestOfSet = 3;
// Of the time, for alpha, depth and files, and seconds for each pixel of the picture; the same for the blurs of a
// correction.
constexpr double kWriting = 0.02, kWritingOfPixel = 0.3e-6, kCorrectionOfPixel = 0.3e-6;
constexpr std::size_t kTimedPixels = 512;
constexpr const char* kStage = "choice for the time";

struct Option {
    Shot shot;
    double seconds;  // of wall time, for what is left of the frame
    double error;    // expected
    std::string text;
    std::optional<double> camera_end = std::nullopt;  // as of TimedSettings
};

struct Timing {
    const Shot& shot;
    const Medium& medium;
    const CameraSettings& camera;
    const TimeBudget& budget;
    double end() const {
        const double pixels = double(camera.width) * camera.height;
        return (1.0 - kWriting) * budget.seconds - kWritingOfPixel * pixels;
    }
    double left() const { return end() - budget.spent; }
};

Shot with_lights(Shot shot, const Step& s) {
    shot.lighting.error = s.error;
    shot.lighting.alpha = s.alpha;
    shot.scattering.alpha = s.scattering_alpha;
    return shot;
}

Option grid_option(const Timing& t, const Plan& plan, const Surroundings* surroundings) {
    Option out;
    const CountedMedium counted(t.medium);
    const bool corrects = t.shot.correction.samples == kAutomaticCorrection;
    const double blurs = kCorrectionOfPixel * double(t.camera.width) * t.camera.height;
    double share = 0.0;
    for (int step = step_count() - 1; step >= 0; --step) {
        const Step& of_step = kGridSteps.at(static_cast<std::size_t>(step));
        out.shot = with_step(t.shot, step);
        if (corrects && of_step.most_correction > 0.0 && t.shot.lighting.lattice_error < 0.0f)
            out.shot.lighting.lattice_error = of_step.lattice_error;
        CameraSettings camera = t.camera;
        if (step == 0)
            camera.samples_per_axis = 1;
        const double alone =
            kMargin * (1.0 + t.shot.certify.belief) * grid_seconds(out.shot, counted, plan, camera) / t.budget.speed;
        // Times as long, which are left for samples.
        const double more = (t.left() - (corrects && of_step.most_correction > 0.0 ? blurs : 0.0)) / alone - 1.0;
        share = corrects ? std::clamp(more, 0.0, of_step.most_correction) : 0.0;
        out.seconds = (1.0 + share) * alone + (share > 0.0 ? blurs : 0.0);
        if (more >= (corrects ? of_step.least_correction : 0.0))
            break;
    }
    out.shot.method = RenderMethod::LightingGrid;
    if (corrects)
        out.shot.correction.samples = 0;
    if (share > 0.0) {
        const PathTracer tracer(t.medium, t.shot.tracing, t.shot.scattering.bounces, surroundings);
        out.shot.correction.samples =
            static_cast<int>(samples_of_share(share, out.shot, counted, plan, tracer, Camera(t.camera, t.medium)));
    }
    out.error = expected_error({out.shot, t.medium, plan}).error * std::pow(1.0 + share, -kCorrected);
    out.text = fmt::format(
        "the lighting grid with lighting.error={:.3g}, lighting.alpha={:.2g} and {}correction", out.shot.lighting.error,
        out.shot.lighting.alpha,
        out.shot.correction.samples > 0 ? fmt::format("{} samples for its ", out.shot.correction.samples) : "no ");
    return out;
}

Option path_option(const Timing& t, const Surroundings* surroundings) {
    const PathTracer tracer(t.medium, t.shot.tracing, t.shot.scattering.bounces, surroundings);
    const PathPilot pilot = trace_pilot(tracer, Camera(t.camera, t.medium), kTimedPixels);
    const double pixels = double(t.camera.width) * t.camera.height;
    const double pass = 2.0 * kPathMargin * pixels * pilot.ray_seconds() / t.budget.speed;
    const double set_up = kPathMargin * tracer_seconds(t.medium) / t.budget.speed;
    const double tracing = std::max(t.left() - set_up - pass, 1e-3);
    Option out{t.shot, set_up + pass + tracing, 0.0, {}};
    out.shot.method = RenderMethod::Path;
    out.shot.tracing.samples = 0;
    out.shot.tracing.seconds = tracing;
    out.error = std::sqrt(pilot.square_error / (2.0 * std::max(1.0, (tracing + pass) / pass)));
    out.text = fmt::format("the path tracer with tracing.seconds={:.3g}", tracing);
    return out;
}

// With a set: its lights are known within a factor of three, and what is left is the camera's.
Option set_option(const Timing& t, const Plan& plan) {
    Option out;
    const CountedMedium counted(t.medium);
    for (int step = kFinestOfSet; step >= 0; --step) {
        out.shot = with_lights(t.shot, kGridSteps.at(static_cast<std::size_t>(step)));
        out.seconds = lighting_seconds(out.shot, counted, plan) / t.budget.speed;
        if (out.seconds <= kLightsOfSet * t.left())
            break;
    }
    out.shot.method = RenderMethod::LightingGrid;
    if (t.shot.correction.samples == kAutomaticCorrection)
        out.shot.correction.samples = 0;
    out.error = out.shot.lighting.error;
    const double belief = t.shot.certify.belief * grid_seconds(out.shot, counted, plan, t.camera) / t.budget.speed;
    out.camera_end = t.end() - belief;
    out.text = fmt::format(
        "the lighting grid with lighting.error={:.3g}, lighting.alpha={:.2g} and as many samples as "
        "fit once its lights are there",
        out.shot.lighting.error, out.shot.lighting.alpha);
    return out;
}

// None: nothing can be forecast.
std::optional<Option> best_option(const Timing& t, const Surroundings* surroundings) {
    Shot grid = t.shot;
    grid.method = RenderMethod::LightingGrid;
    const Plan plan = plan_cells(grid, t.medium, surroundings);
    std::optional<Option> best;
    if (t.shot.method != RenderMethod::Path && grid_is_forecast(plan))
        best = grid_option(t, plan, surroundings);
    else if (t.shot.method != RenderMethod::Path && samples_follow_time(grid, plan, t.camera))
        return set_option(t, plan);
    if (t.shot.method == RenderMethod::Path || (t.shot.method == RenderMethod::Automatic && best)) {
        const Option paths = path_option(t, surroundings);
        const bool grid_fits = best && best->seconds <= t.left();
        if (!best || (paths.seconds <= t.left() && paths.error < best->error) ||
            (!grid_fits && paths.seconds < best->seconds))
            best = paths;
    }
    return best;
}

}  // namespace

int step_count() {
    return static_cast<int>(kGridSteps.size());
}

Shot with_step(Shot shot, int step) {
    const Step& of_step = kGridSteps.at(static_cast<std::size_t>(step));
    shot = with_lights(std::move(shot), of_step);
    if (!(of_step.most_correction > 0.0) && shot.lighting.lattice_error < 0.0f)
        shot.lighting.lattice_error = of_step.lattice_error;
    if (step == 0) {
        shot.camera.samples_per_axis = 1;
        shot.camera.edge_refinement = 1;
        shot.scattering.remainder = std::max(shot.scattering.remainder, 0.01f);
    }
    return shot;
}

TimedSettings settings_for_time(const Shot& shot, const Medium& medium, const Surroundings* surroundings,
                                const CameraSettings& camera, const TimeBudget& given, Progress& progress) {
    progress.stage(kStage);
    const Stopwatch watch;
    TimedSettings out;
    out.shot = shot;
    const Timing timing{shot, medium, camera, given};
    if (const std::optional<Option> best = best_option(timing, surroundings)) {
        out.shot = best->shot;
        out.seconds = given.spent + best->seconds;
        out.camera_end = best->camera_end;
        out.too_short = !out.camera_end && best->seconds > timing.left();
        out.reason = fmt::format("seconds={:.3g}: {}", given.seconds, best->text);
        if (!out.camera_end)
            out.reason += fmt::format(", which should take {:.2g} s on a machine that does {:.2g} core seconds in one",
                                      out.seconds, given.speed);
        progress.notice(out.reason);
        if (out.too_short)
            progress.warning("seconds", fmt::format("{:.3g} s do not suffice: the coarsest settings should take {:.2g} "
                                                    "s, of which {:.2g} s are gone already",
                                                    given.seconds, out.seconds, given.spent));
    } else {
        out.reason =
            "with another scattering.method, several passes of virtual lights, or stated samples of a set, times "
            "are known for method=path only";
        progress.warning("seconds", out.reason + ": the shot's own settings stay");
    }
    out.shot.seconds = 0.0;
    out.cost = {kStage,
                watch.seconds(),
                0,
                {{"seconds", given.seconds},
                 {"forecast_seconds", out.seconds},
                 {"machine_speed", given.speed},
                 {"method", out.shot.method == RenderMethod::Path ? "path" : "lighting_grid"},
                 {"lighting_error", out.shot.lighting.error},
                 {"lattice_error", out.shot.lighting.lattice_error >= 0.0f
                                       ? nlohmann::ordered_json(out.shot.lighting.lattice_error)
                                       : nlohmann::ordered_json("auto")},
                 {"lighting_alpha", out.shot.lighting.alpha},
                 {"tracing_seconds", out.shot.tracing.seconds}}};
    return out;
}

TimedSettings settings_for_time(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& progress) {
    const double speed = machine_speed();
    const Stopwatch watch;
    Statistics statistics;
    const FrameInput input = load_frame(shot, volume, frame, statistics, progress);
    TimedSettings out = settings_for_time(shot, input.medium, input.surroundings.get(), input.camera,
                                          {shot.seconds, watch.seconds(), speed}, progress);
    if (out.camera_end) {
        const Plan plan = plan_cells(out.shot, input.medium, input.surroundings.get());
        const Camera camera(input.camera, input.medium);
        const DrawInput draw{out.shot, plan, input.medium, input.surroundings.get(), camera};
        const ManyLights lights(draw, statistics, progress);
        const CameraTime time{watch, *out.camera_end};
        const CameraSettings chosen = camera_for_time(draw, lights, time.left(), statistics, progress);
        out.shot.camera.samples_per_axis = chosen.samples_per_axis;
        out.shot.camera.edge_refinement = chosen.edge_refinement;
        out.camera_end.reset();
    }
    out.cost.seconds = watch.seconds();
    return out;
}

}  // namespace brisance
