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
#include "render/input/frame_input.h"

namespace brisance {

namespace {

// From coarse to fine. Errors below 0.02 are reached by a correction (correction/correct.h).
struct Step {
    float error, alpha, scattering_alpha;
    double correction = 0.0;  // seconds of unbiased samples over those of the picture
};
constexpr std::array<Step, 6> kGridSteps = {{{0.1f, 1.0f, 1.0f},
                                             {0.05f, 1.0f, 1.0f},
                                             {0.03f, 1.5f, 1.25f},
                                             {0.02f, 2.0f, 1.5f},
                                             {0.02f, 2.0f, 1.5f, 1.5},
                                             {0.01f, 3.0f, 2.0f, 2.0}}};

// Forecasts of the lighting grid are up to 30 % too low (docs/numbers.md).
constexpr double kMargin = 1.3;
// Of the path tracer they matter for its set-up and its last pass only.
constexpr double kPathMargin = 1.1;
// The error falls about as this power of the time while a correction takes more of it (docs/numbers.md).
constexpr double kCorrected = 0.45;
constexpr double kWriting = 0.02;  // of the time, for alpha, depth and files
constexpr std::size_t kTimedPixels = 512;
constexpr const char* kStage = "choice for the time";

struct Option {
    Shot shot;
    double seconds;  // of wall time, for what is left of the frame
    double error;    // expected
    std::string text;
};

struct Timing {
    const Shot& shot;
    const Medium& medium;
    const CameraSettings& camera;
    const TimeBudget& budget;
    double left() const { return (1.0 - kWriting) * budget.seconds - budget.spent; }
};

Option grid_option(const Timing& t, const Plan& plan, const Surroundings* surroundings) {
    Option out;
    const CountedMedium counted(t.medium);
    double share = 0.0;
    for (int step = step_count() - 1; step >= 0; --step) {
        out.shot = with_step(t.shot, step);
        if (t.shot.correction.samples == kAutomaticCorrection)
            share = kGridSteps.at(static_cast<std::size_t>(step)).correction;
        CameraSettings camera = t.camera;
        if (step == 0)
            camera.samples_per_axis = 1;
        const double cost = (1.0 + share) * grid_seconds(out.shot, counted, plan, camera);
        out.seconds = kMargin * (1.0 + t.shot.certify.belief) * cost / t.budget.speed;
        if (out.seconds <= t.left())
            break;
    }
    out.shot.method = RenderMethod::LightingGrid;
    if (t.shot.correction.samples == kAutomaticCorrection)
        out.shot.correction.samples = static_cast<int>(
            samples_of_share(share, out.shot, counted, plan, Camera(t.camera, t.medium), surroundings));
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

// None: nothing can be forecast.
std::optional<Option> best_option(const Timing& t, const Surroundings* surroundings) {
    Shot grid = t.shot;
    grid.method = RenderMethod::LightingGrid;
    const Plan plan = plan_cells(grid, t.medium, surroundings);
    std::optional<Option> best;
    if (t.shot.method != RenderMethod::Path && grid_is_forecast(plan))
        best = grid_option(t, plan, surroundings);
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
    const Step& s = kGridSteps.at(static_cast<std::size_t>(step));
    shot.lighting.error = s.error;
    shot.lighting.alpha = s.alpha;
    shot.scattering.alpha = s.scattering_alpha;
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
        out.too_short = best->seconds > timing.left();
        out.reason = fmt::format(
            "seconds={:.3g}: {}, which should take {:.2g} s on a machine that does {:.2g} core "
            "seconds in one",
            given.seconds, best->text, out.seconds, given.speed);
        progress.notice(out.reason);
        if (out.too_short)
            progress.warning("seconds", fmt::format("{:.3g} s do not suffice: the coarsest settings should take {:.2g} "
                                                    "s, of which {:.2g} s are gone already",
                                                    given.seconds, out.seconds, given.spent));
    } else {
        out.reason = "shots with surfaces, lamps or another scattering.method are forecast for method=path only";
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
    out.cost.seconds = watch.seconds();
    return out;
}

}  // namespace brisance
