#include "render/choice/forecast_frame.h"

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "camera_rays/automatic_samples.h"
#include "camera_rays/picture.h"
#include "core/stopwatch.h"
#include "correction/correct.h"
#include "forecast/correction_plan.h"
#include "forecast/memory_need.h"
#include "forecast/plan.h"
#include "pixel_sharing/divided_grains.h"
#include "pixel_sharing/shared_bounce.h"
#include "render/bound_layers.h"
#include "render/choice/choose_method.h"
#include "render/choice/time_budget.h"
#include "render/input/frame_input.h"
#include "render/many_lights.h"
#include "surface_lighting/light_reuse.h"
#include "surface_lighting/screen_space_compensation.h"

namespace brisance {

namespace {

constexpr std::size_t kPilotPixelsOfForecast = 1024;
// Of the program itself with its libraries, and of what it keeps for each pixel: the layers, and two more such sets
// while they are written.
constexpr std::uint64_t kProgramBytes = std::uint64_t{80} << 20, kPictures = 3;
// The path tracer's fields and majorants, for each byte of the medium.
constexpr std::uint64_t kTracerMedia = 2;

std::uint64_t picture_bytes(const CameraSettings& camera, std::size_t cells) {
    const std::uint64_t channels = 4 + 3 * cells + 2;
    return kPictures * channels * sizeof(float) * std::uint64_t(camera.width) * std::uint64_t(camera.height);
}

// Rays of a pixel, of which each meets a surface. Where the shot leaves them open: four by four, unless voxels want
// more.
std::size_t surface_rays(const FrameInput& input) {
    const int stated = input.camera.samples_per_axis;
    if (stated > 0)
        return std::size_t(stated) * std::size_t(stated);
    const Camera camera(input.camera, input.medium);
    const int of_medium = automatic_samples(camera, input.medium).enough;
    const int side = std::max(kSurfaceSamples, of_medium);
    return std::size_t(side) * std::size_t(side);
}

// What samples of the camera keep for each other while surfaces are lit.
std::uint64_t bytes_between_pixels(const Shot& shot, const FrameInput& input, const Plan& plan) {
    const VirtualLightSettings& s = shot.virtual_lights;
    const int width = input.camera.width, height = input.camera.height;
    if (shot.method == RenderMethod::Path || !plan.surfaces)
        return 0;
    const bool lights = s.count > 0 && plan.needs(Cell::SS);
    std::uint64_t sum = s.sharing_radius > 0.0 ? DividedGrains::bytes_of(width, height) : 0;
    if (lights && s.sharing_radius > 0.0)
        sum += SharedBounce::bytes_of(width, height, has_bound_layers(shot, plan) ? 1 : SharedBounce::kAparts - 1);
    if (lights && s.compensation == BoundCompensation::ScreenSpace)
        sum += ScreenSpaceCompensation::bytes_of(width, height);
    if (lights && s.resampling_neighbours > 0) {
        const std::size_t rays = surface_rays(input);
        sum += LightReuse::bytes_of(
            width, height, static_cast<int>(rays), rows_at_once(width, height, rays),
            {s.resampling_neighbours, s.resampling_radius, s.resampling_visibility, s.resampling_rounds, s.seed});
    }
    return sum;
}

// When the lights are gone.
std::uint64_t bytes_for_correction(const Shot& shot, const FrameInput& input, const Plan& plan) {
    const bool corrects = shot.correction.samples > 0 || most_of_correction(shot, plan) > 0.0;
    if (shot.method == RenderMethod::Path || !corrects)
        return 0;
    const auto stated = static_cast<std::size_t>(std::max(shot.correction.samples, 0));
    return kTracerMedia * input.medium.bytes() +
           Corrector::bytes_of(input.camera.width, input.camera.height, plan.cells().size(), stated);
}

std::uint64_t bytes_needed(const Shot& shot, const FrameInput& input, const Plan& plan, const Statistics& read) {
    std::uint64_t grids = 0;
    for (const StageCost& stage : read.stages)
        grids += stage.name == "reading" ? stage.bytes : 0;
    const std::uint64_t medium = input.medium.bytes();
    const std::uint64_t work = shot.method == RenderMethod::Path
                                   ? kTracerMedia * medium
                                   : bytes_to_light(input.medium, plan.directional, shot.lighting.memory_limit_bytes);
    return kProgramBytes + picture_bytes(input.camera, plan.cells().size()) + medium +
           bytes_between_pixels(shot, input, plan) + (input.surroundings ? input.surroundings->bytes() : 0) +
           std::max({grids, work, bytes_for_correction(shot, input, plan)});
}

// Core seconds of the path tracer; none where it stops by nothing that is known.
std::optional<double> path_seconds(const Shot& shot, const FrameInput& input) {
    const PathTracer tracer(input.medium, shot.tracing, shot.scattering.bounces, input.surroundings.get());
    const PathPilot pilot = trace_pilot(tracer, Camera(input.camera, input.medium), kPilotPixelsOfForecast);
    double samples = shot.tracing.samples;
    if (shot.tracing.error > 0.0) {
        const double for_error = pilot.square_error / (shot.tracing.error * shot.tracing.error);
        samples = samples > 0.0 ? std::min(samples, for_error) : for_error;
    }
    if (!(samples > 0.0))
        return std::nullopt;
    const double pixels = double(input.camera.width) * input.camera.height;
    return tracer_seconds(input.medium) + pilot.ray_seconds() * samples * pixels;
}

void add_seconds(FrameForecast& out, const Shot& shot, const FrameInput& input, const Plan& plan, double spent,
                 double speed) {
    std::optional<double> core;
    if (shot.method == RenderMethod::Path)
        core = path_seconds(shot, input);
    else if (grid_is_forecast(plan))
        core = (1.0 + shot.certify.belief) * corrected_seconds(shot, CountedMedium(input.medium), plan, input.camera);
    else
        out.why_no_seconds = "surfaces, lamps and other scattering methods are not forecast for the lighting grid";
    if (core)
        out.seconds = spent + *core / speed;
    if (shot.method == RenderMethod::Path && shot.tracing.seconds > 0.0)
        out.seconds = spent + std::min(core ? *core / speed : shot.tracing.seconds, shot.tracing.seconds);
    if (!out.seconds && out.why_no_seconds.empty())
        out.why_no_seconds = "nothing says when the paths end";
}

}  // namespace

FrameForecast forecast_frame(const Shot& given, const std::filesystem::path& volume, int frame, double speed,
                             Progress& progress) {
    const Stopwatch watch;
    Statistics read;
    const FrameInput input = load_frame(given, volume, frame, read, progress);
    const double spent = watch.seconds();
    const Surroundings* const around = input.surroundings.get();
    Shot shot = given;
    shot.camera = input.camera;
    if (shot.seconds > 0.0)
        shot = settings_for_time(shot, input.medium, around, input.camera, {shot.seconds, spent, speed}, progress).shot;
    if (shot.method == RenderMethod::Automatic)
        shot = with_method(shot, forecast_methods(shot, input.medium, around, input.camera, progress));
    const Plan plan = plan_cells(shot, input.medium, around);
    FrameForecast out;
    out.cells = plan.cells();
    out.memory_bytes = bytes_needed(shot, input, plan, read);
    add_seconds(out, shot, input, plan, spent, speed);
    return out;
}

}  // namespace brisance
