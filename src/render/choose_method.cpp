#include "render/choose_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "camera_rays/picture.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "medium_lighting/lit_lattice.h"
#include "reference/trace_picture.h"
#include "render/frame_input.h"
#include "render/plan.h"

namespace brisance {

namespace {

// Seconds of one core at 2.5 GHz, measured on four volumes of 0.2 to 0.7 million nodes: 50 to 57 microseconds a node
// for all orders, 80 with directional light; 0.7 to 1.9 a segment of a path; about 1 a ray of the camera.
constexpr double kNode = 55e-6, kDirectionalNode = 80e-6, kSegment = 1.2e-6, kCameraRay = 1e-6;
constexpr double kSingleOrder = 0.4;       // of a node's time, with one scattering
constexpr double kTrackingOfVoxel = 2e-6;  // set-up of the path tracer

constexpr std::size_t kPilotPixels = 2048;
constexpr int kPilotSamples = 8;
constexpr int kLeastSamples = 16;  // fewer know their own error badly

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
    // Where all is black, so is the picture; where noise hides all light, no number of paths is known to suffice.
    const double noise = variance > 0.0 ? variance / std::max(square, 1e-12 * variance) : 0.0;
    return {noise, double(segments) / (double(count) * double(kPilotSamples))};
}

MethodForecast without_forecast(const std::string& reason) {
    return {RenderMethod::LightingGrid, "method: the lighting grid, since " + reason, 0.0, 0.0, 0.0};
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

}  // namespace

MethodForecast forecast_methods(const Shot& shot, const Medium& medium, const Surroundings* surroundings,
                                const CameraSettings& camera, Statistics& statistics, Progress& progress) {
    progress.stage("choice of the method");
    const Stopwatch watch;
    Shot sized = shot;
    sized.method = RenderMethod::LightingGrid;
    sized.camera = camera;
    const Plan plan = plan_cells(sized, medium, surroundings);
    MethodForecast out;
    if (plan.surfaces || plan.emitters)
        out = without_forecast("shots with surfaces or lamps are not forecast");
    else if (plan.scattering_method)
        out = without_forecast("scattering.method is " + plan.scattering_choice);
    else if (!plan.single)
        out = without_forecast("no light is scattered");
    else
        out = from_counts(sized, medium, plan, camera);
    statistics.stages.push_back({"choice of the method",
                                 watch.seconds(),
                                 0,
                                 {{"method", out.method == RenderMethod::Path ? "path" : "lighting_grid"},
                                  {"path_seconds", out.path_seconds},
                                  {"path_samples", out.samples},
                                  {"grid_seconds", out.grid_seconds}}});
    progress.notice(out.reason);
    return out;
}

MethodForecast forecast_methods(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& progress) {
    Statistics statistics;
    const FrameInput input = load_frame(shot, volume, frame, statistics, progress);
    return forecast_methods(shot, input.medium, input.surroundings.get(), input.camera, statistics, progress);
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
