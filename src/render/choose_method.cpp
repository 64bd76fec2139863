#include "render/choose_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "camera_rays/picture.h"
#include "core/available_memory.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "medium_lighting/lit_lattice.h"
#include "reference/trace_picture.h"
#include "render/frame_input.h"
#include "render/memory_need.h"
#include "render/plan.h"

namespace brisance {

namespace {

// Seconds of one core at 2.5 GHz, fitted to four pictures of 0.2 to 0.7 million nodes: 50 to 57 microseconds a node for
// all orders, 80 with directional light; 0.7 to 1.9 a segment of a path; about 1 a ray of the camera.
constexpr double kNode = 55e-6, kDirectionalNode = 80e-6, kSegment = 1.2e-6, kCameraRay = 1e-6;
constexpr double kSingleOrder = 0.4;       // of a node's time, with one scattering
constexpr double kTrackingOfVoxel = 2e-6;  // set-up of the path tracer

constexpr std::size_t kPilotPixels = 2048;
constexpr int kPilotSamples = 8;
constexpr int kLeastSamples = 16;  // the error of fewer is badly known

double error_wanted(const Shot& shot) {
    return shot.tracing.error > 0.0 ? shot.tracing.error : double(shot.lighting.error);
}

double camera_rays(const Shot& shot, const Medium& medium, const CameraSettings& settings) {
    const Camera camera(settings, medium);
    const int side =
        settings.samples_per_axis > 0 ? settings.samples_per_axis : automatic_samples(camera, SourceField(medium));
    return double(shot.camera.width) * shot.camera.height * side * side;
}

double grid_seconds(const Shot& shot, const Medium& medium, const Plan& plan, const CameraSettings& camera) {
    const std::vector<std::uint8_t> needed = nodes_beside_extinction(medium);
    const auto nodes = std::count_if(needed.begin(), needed.end(), [](std::uint8_t n) { return n != 0; });
    const double each = (plan.directional ? kDirectionalNode : kNode) * (plan.multiple ? 1.0 : kSingleOrder);
    return each * double(nodes) + kCameraRay * camera_rays(shot, medium, camera);
}

// The variance and the length of paths.
struct Pilot {
    double square_error = 0.0;  // of a picture of one camera ray per pixel: the square of its relative standard error
    double segments = 0.0;      // of all paths that one camera ray begins
};

// The samples of one pixel: variance of one, and the square of their mean without its own noise, over all colours.
struct PilotPixel {
    double variance = 0.0, square = 0.0;
    PathStatistics paths;
};

PilotPixel trace_pilot_pixel(const PathTracer& tracer, const Camera& camera, std::size_t pixel) {
    PilotPixel out;
    dvec3 sum(0.0), squares(0.0);
    for (std::uint64_t k = 0; k < kPilotSamples; ++k) {
        dvec3 light(0.0);
        for (const Rgb& order : trace_sample(tracer, camera, pixel, k, out.paths))
            light += dvec3(order);
        if (!std::isfinite(light.x + light.y + light.z))
            continue;
        sum += light;
        squares += light * light;
    }
    const dvec3 mean = sum / double(kPilotSamples);
    const dvec3 variance = (squares - mean * sum) / double(kPilotSamples - 1);
    out.variance = variance.x + variance.y + variance.z;
    out.square = glm::dot(mean, mean) - out.variance / double(kPilotSamples);
    return out;
}

// Traces pixels spread evenly over the picture.
Pilot run_pilot(const Shot& shot, const Medium& medium, const CameraSettings& settings) {
    const Camera camera(settings, medium);
    const PathTracer tracer(medium, shot.tracing, shot.scattering.bounces, nullptr);
    const std::size_t all = std::size_t(settings.width) * settings.height, count = std::min(all, kPilotPixels);
    std::vector<PilotPixel> pixels(count);
    parallel_for(count, [&](std::size_t i) {
        // Golden-ratio steps: no column or row is met more often than others.
        const double at = std::fmod(double(i) * 0.61803398874989484820, 1.0);
        pixels[i] = trace_pilot_pixel(tracer, camera, std::min(all - 1, static_cast<std::size_t>(at * double(all))));
    });
    double variance = 0.0, square = 0.0;
    std::uint64_t segments = 0;
    for (const PilotPixel& p : pixels) {
        variance += p.variance;
        square += p.square;
        segments += p.paths.paths + p.paths.scatterings;
    }
    // A black pilot needs no paths. Where noise hides all light, paths are taken to need far too many.
    const double noise = variance > 0.0 ? variance / std::max(square, 1e-12 * variance) : 0.0;
    return {noise, double(segments) / (double(count) * double(kPilotSamples))};
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
    out.grid_seconds = grid_seconds(shot, medium, plan, camera);
    const Pilot pilot = run_pilot(shot, medium, camera);
    const double wanted = error_wanted(shot);
    out.samples = std::max(double(kLeastSamples), std::ceil(pilot.square_error / (wanted * wanted)));
    out.path_seconds = kTrackingOfVoxel * double(medium.lattice.node_count()) +
                       kSegment * pilot.segments * out.samples * shot.camera.width * shot.camera.height;
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
