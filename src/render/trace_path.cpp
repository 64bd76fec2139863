#include "render/trace_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "camera/camera.h"
#include "core/error.h"
#include "reference/trace_picture.h"
#include "render/input/frame_input.h"
#include "render/shutter/open_shutter.h"

namespace brisance {

namespace {

bool all_finite(std::span<const Rgb> colours) {
    return std::all_of(colours.begin(), colours.end(),
                       [](const Rgb& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); });
}

}  // namespace

bool TracedPath::finite() const {
    return all_finite(orders);
}

bool finite(const TracedVertex& vertex) {
    return all_finite(std::array{vertex.throughput, vertex.along_segment, vertex.from_fire, vertex.from_emitters});
}

TracedPath trace_path(const Shot& shot, const std::filesystem::path& volume, int frame, int x, int y,
                      std::uint64_t sample, Progress& progress) {
    if (x < 0 || y < 0 || x >= shot.camera.width || y >= shot.camera.height)
        throw Error(ExitCode::Usage, "pixel " + std::to_string(x) + " " + std::to_string(y) +
                                         " is outside of the picture, which has " + std::to_string(shot.camera.width) +
                                         " x " + std::to_string(shot.camera.height));
    Statistics statistics;
    const FrameInput input = load_frame(shot, volume, frame, statistics, progress);
    const Camera camera(input.camera, input.medium);
    const OpenShutter shutter(shot.shutter, input.medium, input.surroundings.get(), input.camera, input.animation,
                              progress);
    const Moment frame_itself{&input.medium, input.surroundings.get(), &camera};
    const MomentTracers tracers(shutter.still() ? std::span(&frame_itself, 1) : shutter.moments(), shot.tracing,
                                shot.scattering.bounces);
    const std::size_t pixel = std::size_t(y) * shot.camera.width + x;
    const std::size_t moment = moment_of_sample(shot.tracing.seed, pixel, sample, tracers);
    TracedPath out;
    PathStatistics counts;
    counts.vertices = &out.vertices;
    out.orders = trace_sample(tracers.tracer(moment), tracers.camera(moment), pixel, sample, counts);
    out.has_cells = input.surroundings != nullptr;
    out.scatterings = counts.scatterings;
    for (TracedVertex& vertex : out.vertices)
        vertex.position += input.medium.world_of_local(vec3(0.0f));
    const Camera& then = tracers.camera(moment);
    const Ray local = sample_ray(then, shot.tracing.seed, pixel, sample);
    out.ray = {dvec3(glm::inverse(then.camera_from_world())[3]), local.direction};  // local space is not turned
    return out;
}

}  // namespace brisance
