#include "render/camera_ray_lights.h"

#include <fmt/format.h>

#include <algorithm>

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

constexpr const char* kStage = "ray lights (MM, SM)";

// Over all passes.
struct Totals {
    double seconds = 0.0, radius = 0.0;  // of all; of the last [m]
    std::uint64_t bytes = 0;             // of the largest
    RayLightReport report;

    void add(const RayLights& lights, double spent) {
        const RayLightReport& r = lights.report();
        seconds += spent;
        radius = lights.radius();
        bytes = std::max(bytes, lights.bytes());
        report.paths += r.paths;
        report.flights += r.flights;
        report.pieces += r.pieces;
        report.lights += r.lights;
        report.not_finite += r.not_finite;
    }
};

// Of `count` pictures, one after another.
void add_to_mean(Image& mean, const Image& next, int count) {
    for (std::size_t l = 0; l < mean.layers.size(); ++l)
        for (std::size_t i = 0; i < mean.layers[l].pixels.size(); ++i) {
            float& pixel = mean.layers[l].pixels[i];
            pixel += (next.layers[l].pixels[i] - pixel) / float(count);
        }
}

}  // namespace

Image mean_of_passes(const Shot& shot, const DirectLight& scene, const Camera& camera, const DrawPass& draw,
                     double& seconds, Statistics& statistics, Progress& progress) {
    const std::vector<RayLightReceiver> receivers = ray_light_receivers(scene, camera);
    const int passes = shot.ray_lights.passes;
    Totals totals;
    double first = 0.0;
    Image mean;
    for (int pass = 0; pass < passes; ++pass) {
        progress.stage(passes > 1 ? fmt::format("{}, pass {} of {}", kStage, pass + 1, passes) : std::string(kStage));
        const Stopwatch watch;
        const RayLights lights(scene, settings_of_pass(shot.ray_lights, pass, first), shot.scattering.bounces,
                               receivers);
        totals.add(lights, watch.seconds());
        if (pass == 0)
            first = lights.radius();
        progress.stage("camera");
        Image picture = draw(&lights, pass);
        if (pass == 0)
            mean = std::move(picture);
        else
            add_to_mean(mean, picture, pass + 1);
    }
    const RayLightReport& r = totals.report;
    statistics.stages.push_back({kStage,
                                 totals.seconds,
                                 totals.bytes,
                                 {{"particles", r.paths},
                                  {"flights", r.flights},
                                  {"pieces", r.pieces},
                                  {"lights", r.lights},
                                  {"not_finite", r.not_finite},
                                  {"passes", passes},
                                  {"first_radius", first},
                                  {"last_radius", totals.radius}}});
    seconds = totals.seconds;
    return mean;
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
