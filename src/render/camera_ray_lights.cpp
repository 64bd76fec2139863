#include "render/camera_ray_lights.h"

#include "core/error.h"
#include "core/stopwatch.h"

namespace brisance {

namespace {

// Rays of the camera that stand for all of them when ray lights are thinned out, along a side of the picture.
constexpr int kReceivers = 12;

// Who is lit by ray lights: the smoke on some of the camera's rays, and the surfaces behind it.
std::vector<RayLightReceiver> ray_light_receivers(const DirectLight& scene, const Camera& camera) {
    std::vector<RayLightReceiver> receivers;
    SeenMedium seen;
    for (int y = 0; y < kReceivers; ++y)
        for (int x = 0; x < kReceivers; ++x) {
            const Ray ray = camera.ray((x + 0.5) / kReceivers * camera.settings().width,
                                       (y + 0.5) / kReceivers * camera.settings().height);
            const RaySegment segment = scene.segment_along(ray);
            seen.look(scene.field(), ray, segment.end);
            if (!seen.empty())
                receivers.push_back(receiver_along(seen));
            if (segment.point)
                receivers.push_back(RayLightReceiver::at(segment.point->position, segment.point->frame.normal));
        }
    return receivers;
}

}  // namespace

std::unique_ptr<RayLights> trace_ray_lights_of(const Shot& shot, const DirectLight& scene, const Camera& camera,
                                               Statistics& statistics, Progress& progress) {
    progress.stage("ray lights (MM, SM)");
    const Stopwatch watch;
    auto lights = std::make_unique<RayLights>(scene, shot.ray_lights, shot.scattering.bounces,
                                              ray_light_receivers(scene, camera));
    const RayLightReport& r = lights->report();
    statistics.stages.push_back({"ray lights (MM, SM)",
                                 watch.seconds(),
                                 lights->bytes(),
                                 {{"particles", r.paths},
                                  {"flights", r.flights},
                                  {"pieces", r.pieces},
                                  {"lights", r.lights},
                                  {"not_finite", r.not_finite}}});
    return lights;
}

LightRays light_rays_by(const RayLights& lights, const TrackingField& field) {
    return [&](const PixelRay& r, double end) {
        thread_local SeenMedium seen;
        seen.look(field, r.ray, end);
        Rng rng(Stream::RayLightPair, r.pixel, r.number);
        return lights.along_ray(seen, rng);
    };
}

Plan without_ray_lights(Plan plan) {
    plan.multiple = false;
    plan.needed[static_cast<int>(Cell::MM)] = plan.needed[static_cast<int>(Cell::SM)] = false;
    return plan;
}

// One scattering in smoke alone leaves the camera's rays the peak of the phase function (similar_medium.h), which they
// find again for fire; light from a set needs its peaks as they are.
int bounces_beside_ray_lights(const Plan& plan) {
    return plan.needs(Cell::MS) || plan.needs(Cell::MA) ? 2 : 1;
}

void check_ray_lights(const Shot& shot) {
    if (shot.lighting.gather == GatherMethod::RayMarch)
        throw Error(ExitCode::Usage,
                    "lighting.gather: ray_march does not work with scattering.method ray_lights; use cache");
}

}  // namespace brisance
