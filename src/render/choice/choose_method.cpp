#include "render/choice/choose_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "core/available_memory.h"
#include "core/stopwatch.h"
#include "forecast/correction_plan.h"
#include "forecast/memory_need.h"
#include "forecast/plan.h"
#include "render/input/frame_input.h"

namespace brisance {

namespace {

constexpr std::size_t kPilotPixels = 2048;
constexpr int kLeastSamples = 16;  // the error of fewer is badly known

double error_wanted(const Shot& shot) {
    return shot.tracing.error > 0.0 ? shot.tracing.error : double(shot.lighting.error);
}

MethodForecast without_forecast(RenderMethod method, const std::string& reason) {
    MethodForecast out;
    out.method = method;
    out.reason = fmt::format("method: {}, since {}",
                             method == RenderMethod::Path ? "the path tracer" : "the lighting grid", reason);
    return out;
}

MethodForecast from_counts(const Shot& shot, const Medium& medium, const Plan& plan, const CameraSettings& camera) {
    MethodForecast out;
    out.grid_seconds = corrected_seconds(shot, CountedMedium(medium), plan, camera);
    const PathTracer tracer(medium, shot.tracing, shot.scattering.bounces, nullptr);
    const PathPilot pilot = trace_pilot(tracer, Camera(camera, medium), kPilotPixels);
    const double wanted = error_wanted(shot);
    out.samples = std::max(double(kLeastSamples), std::ceil(pilot.square_error / (wanted * wanted)));
    out.path_seconds =
        tracer_seconds(medium) + pilot.ray_seconds() * out.samples * shot.camera.width * shot.camera.height;
    const bool paths = out.path_seconds < out.grid_seconds;
    out.method = paths ? RenderMethod::Path : RenderMethod::LightingGrid;
    out.reason = fmt::format(
        "method: {}, since to an error of {:.3g} % the path tracer takes about {:.2g} s of one "
        "core ({:.0f} samples a pixel) and the lighting grid {:.2g} s",
        paths ? "the path tracer" : "the lighting grid", 100.0 * wanted, out.path_seconds, out.samples,
        out.grid_seconds);
    return out;
}

bool fits_in_memory(const Shot& shot, const Medium& medium, const Plan& plan) {
    const std::optional<std::uint64_t> available = available_memory();
    return !available || bytes_to_light(medium, plan.directional, shot.lighting.memory_limit_bytes) <= *available;
}

MethodForecast forecast(const Shot& shot, const Medium& medium, const Plan& plan, const CameraSettings& camera) {
    const auto grid_since = [](const std::string& reason) {
        return without_forecast(RenderMethod::LightingGrid, reason);
    };
    if (plan.surfaces || plan.emitters)
        return grid_since("shots with surfaces or lamps are not forecast");
    if (plan.scattering_method)
        return grid_since("scattering.method is " + plan.scattering_choice);
    if (plan.fire_sampling)
        return grid_since(std::string("fire_lights.sampling is ") + plan.fire_sampling->name);
    if (plan.unified_sampling)
        return grid_since(std::string("unified_lights.sampling is ") + plan.unified_sampling->name);
    if (!plan.single)
        return grid_since("no light is scattered");
    if (!fits_in_memory(shot, medium, plan))
        return without_forecast(RenderMethod::Path, "the lighting grid needs more memory than there is");
    return from_counts(shot, medium, plan, camera);
}

}  // namespace

MethodForecast forecast_methods(const Shot& shot, const Medium& medium, const Surroundings* surroundings,
                                const CameraSettings& camera, Progress& progress) {
    progress.stage("choice of the method");
    const Stopwatch watch;
    Shot sized = shot;
    sized.method = RenderMethod::LightingGrid;
    sized.camera = camera;
    MethodForecast out = forecast(sized, medium, plan_cells(sized, medium, surroundings), camera);
    out.cost = {"choice of the method",
                watch.seconds(),
                0,
                {{"method", out.name()},
                 {"path_seconds", out.path_seconds},
                 {"path_samples", out.samples},
                 {"grid_seconds", out.grid_seconds}}};
    progress.notice(out.reason);
    return out;
}

MethodForecast forecast_methods(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& progress) {
    const Stopwatch watch;
    Statistics statistics;
    const FrameInput input = load_frame(shot, volume, frame, statistics, progress);
    MethodForecast out = forecast_methods(shot, input.medium, input.surroundings.get(), input.camera, progress);
    out.cost.seconds = watch.seconds();
    return out;
}

Shot with_method(Shot shot, const MethodForecast& forecast) {
    shot.method = forecast.method;
    if (forecast.method == RenderMethod::Path) {
        shot.tracing.error = error_wanted(shot);
        shot.tracing.samples = 0;
    }
    return shot;
}

}  // namespace brisance
