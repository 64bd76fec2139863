#include "render/camera_scattered_lights.h"

#include "core/error.h"
#include "core/stopwatch.h"
#include "medium_points/medium_points.h"
#include "ray_lights/ray_lights.h"

namespace brisance {

namespace {

// Rays of the camera that stand for all of them when lights are thinned out, along a side of the picture.
constexpr int kReceivers = 12;

// Who is lit by them: the smoke on some of the camera's rays, and the surfaces behind it.
std::vector<RayLightReceiver> receivers_of(const DirectLight& scene, const Camera& camera) {
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

std::unique_ptr<LightsInSmoke> ray_lights(const Shot& shot, const DirectLight& scene, const Camera& camera,
                                          StageCost& cost) {
    auto lights =
        std::make_unique<RayLights>(scene, shot.ray_lights, shot.scattering.bounces, receivers_of(scene, camera));
    const RayLightReport& r = lights->report();
    cost.bytes = lights->bytes();
    cost.detail = {{"particles", r.paths},
                   {"flights", r.flights},
                   {"pieces", r.pieces},
                   {"lights", r.lights},
                   {"not_finite", r.not_finite}};
    return lights;
}

std::unique_ptr<LightsInSmoke> point_lights(const Shot& shot, const DirectLight& scene, const Camera& camera,
                                            StageCost& cost) {
    auto lights =
        std::make_unique<MediumPoints>(scene, shot.point_lights, shot.scattering.bounces, receivers_of(scene, camera));
    const MediumPointReport& r = lights->report();
    cost.bytes = lights->bytes();
    cost.detail = {{"particles", r.paths},
                   {"flights", r.flights},
                   {"collisions", r.collisions},
                   {"lights", r.lights},
                   {"not_finite", r.not_finite},
                   {"bound_per_metre2", lights->bound().per_metre2()},
                   {"bound_radius_metres", lights->bound().radius()}};
    return lights;
}

}  // namespace

std::unique_ptr<LightsInSmoke> trace_scattered_lights(const Shot& shot, const DirectLight& scene, const Camera& camera,
                                                      Statistics& statistics, Progress& progress) {
    const bool points = shot.ray_lights.method == ScatteringMethod::PointLights;
    StageCost cost;
    cost.name = points ? "point lights (MM, SM)" : "ray lights (MM, SM)";
    progress.stage(cost.name);
    const Stopwatch watch;
    auto lights = points ? point_lights(shot, scene, camera, cost) : ray_lights(shot, scene, camera, cost);
    cost.seconds = watch.seconds();
    statistics.stages.push_back(std::move(cost));
    return lights;
}

LightRays light_rays_by(const LightsInSmoke& lights, const TrackingField& field) {
    return [&](const PixelRay& r, double end) {
        thread_local SeenMedium seen;
        seen.look(field, r.ray, end);
        Rng rng = lights.rng(Stream::RayLightPair, r.pixel, r.number);
        return lights.along_ray(seen, rng);
    };
}

Plan without_scattered_lights(Plan plan) {
    plan.multiple = false;
    plan.needed[static_cast<int>(Cell::MM)] = plan.needed[static_cast<int>(Cell::SM)] = false;
    return plan;
}

// One scattering in smoke alone leaves the camera's rays the peak of the phase function (similar_medium.h), which they
// find again for fire; light from a set needs its peaks as they are.
int bounces_beside_scattered_lights(const Plan& plan) {
    return plan.needs(Cell::MS) || plan.needs(Cell::MA) ? 2 : 1;
}

void check_scattered_lights(const Shot& shot) {
    if (shot.lighting.gather == GatherMethod::RayMarch)
        throw Error(ExitCode::Usage, std::string("lighting.gather: ray_march does not work with scattering.method ") +
                                         name_of(shot.ray_lights.method) + "; use cache");
}

}  // namespace brisance
