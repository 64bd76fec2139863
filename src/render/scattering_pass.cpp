#include "render/scattering_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/error.h"
#include "core/stopwatch.h"
#include "ray_lights/ray_lights.h"
#include "transport/emitters_along_ray.h"
#include "volumetric_photons/volumetric_photons.h"
#include "volumetric_vpls/volumetric_vpls.h"

namespace brisance {

namespace {

// Rays of the camera that stand for all of them when lights are thinned out, along a side of the picture.
constexpr int kReceivers = 12;

// On every ray of the camera, where it asks emitters.
constexpr int kEmitterPlaces = 16;

// Who is lit by them: the smoke on some of the camera's rays, and the surfaces behind it.
std::vector<LightReceiver> receivers_of(const DirectLight& scene, const Camera& camera) {
    std::vector<LightReceiver> receivers;
    RayMedium seen;
    for (int y = 0; y < kReceivers; ++y)
        for (int x = 0; x < kReceivers; ++x) {
            const Ray ray = camera.ray((x + 0.5) / kReceivers * camera.settings().width,
                                       (y + 0.5) / kReceivers * camera.settings().height);
            const RaySegment segment = scene.segment_along(ray);
            seen.look(scene.field(), ray, segment.end);
            if (!seen.empty())
                receivers.push_back(receiver_along(seen));
            if (segment.point)
                receivers.push_back(LightReceiver::at(segment.point->position, segment.point->frame.normal));
        }
    return receivers;
}

struct Made {
    std::unique_ptr<InScattering> lights;
    std::uint64_t bytes = 0;
    nlohmann::ordered_json detail;
    double radius = 0.0;  // [m]
};

Made ray_lights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
                const std::vector<LightReceiver>& receivers) {
    auto lights = std::make_unique<RayLights>(scene, settings, bounces, receivers);
    const RayLightReport& r = lights->report();
    Made made{nullptr, lights->bytes(), {}, lights->radius()};
    made.detail = {{"particles", r.paths}, {"flights", r.flights},       {"pieces", r.pieces},
                   {"lights", r.lights},   {"not_finite", r.not_finite}, {"last_radius", lights->radius()}};
    made.lights = std::move(lights);
    return made;
}

Made point_lights(const DirectLight& scene, const VolumetricVplSettings& settings, int bounces,
                  const std::vector<LightReceiver>& receivers) {
    auto lights = std::make_unique<VolumetricVpls>(scene, settings, bounces, receivers);
    const VolumetricVplReport& r = lights->report();
    Made made{nullptr, lights->bytes(), {}, 0.0};
    made.detail = {{"particles", r.paths},
                   {"flights", r.flights},
                   {"collisions", r.collisions},
                   {"lights", r.lights},
                   {"not_finite", r.not_finite},
                   {"bound_per_metre2", lights->bound().per_metre2()},
                   {"bound_radius_metres", lights->bound().radius()}};
    made.lights = std::move(lights);
    return made;
}

Made particle_tracks(const DirectLight& scene, const VolumetricPhotonSettings& settings, int bounces,
                     const Camera& camera) {
    const Surroundings* const surroundings = scene.surroundings();
    const bool other_rays = surroundings && surroundings->scene().is_glossy();
    auto tracks = std::make_unique<VolumetricPhotons>(scene, settings, bounces, camera.eye_local(), other_rays);
    const VolumetricPhotonReport& r = tracks->report();
    Made made{nullptr, tracks->bytes(), {}, 0.0};
    made.detail = {
        {"particles", r.paths}, {"flights", r.flights}, {"landings", r.landings}, {"not_finite", r.not_finite}};
    made.lights = std::move(tracks);
    return made;
}

// What one pass cost, after others: counts add up.
void add(StageCost& to, const Made& pass, double seconds) {
    to.seconds += seconds;
    to.bytes = std::max(to.bytes, pass.bytes);
    for (const auto& [key, value] : pass.detail.items()) {
        const bool counts = value.is_number_unsigned() && to.detail.contains(key);
        to.detail[key] =
            counts ? nlohmann::ordered_json(value.get<std::uint64_t>() + to.detail[key].get<std::uint64_t>()) : value;
    }
}

// Of `count` pictures, one after another.
void add_to_mean(Image& mean, const Image& next, int count) {
    for (std::size_t l = 0; l < mean.layers.size(); ++l)
        for (std::size_t i = 0; i < mean.layers[l].pixels.size(); ++i) {
            float& pixel = mean.layers[l].pixels[i];
            pixel += (next.layers[l].pixels[i] - pixel) / float(count);
        }
}

bool by_rays(const Plan& plan) {
    return plan.scattering == ScatteringMethod::RayLights;
}

}  // namespace

int passes_of(const Shot& shot, const Plan& plan) {
    return by_rays(plan) ? shot.ray_lights.passes : 1;
}

Image mean_of_passes(const Shot& shot, const Plan& plan, const DirectLight& scene, const Camera& camera,
                     const DrawPass& draw, double& seconds, Statistics& statistics, Progress& progress) {
    std::vector<LightReceiver> receivers;
    if (plan.scattering != ScatteringMethod::Particles)
        receivers = receivers_of(scene, camera);
    const int passes = passes_of(shot, plan), bounces = shot.scattering.bounces;
    StageCost cost{things_of(plan.scattering) + std::string(" (MM, SM)"), 0.0, 0, {}};
    double first = 0.0;
    const auto make = [&](int pass) {
        switch (plan.scattering) {
            case ScatteringMethod::PointLights:
                return point_lights(scene, shot.point_lights, bounces, receivers);
            case ScatteringMethod::Particles:
                return particle_tracks(scene, shot.particles, bounces, camera);
            default:
                return ray_lights(scene, settings_of_pass(shot.ray_lights, pass, first), bounces, receivers);
        }
    };
    Image mean;
    for (int pass = 0; pass < passes; ++pass) {
        progress.stage(passes > 1 ? fmt::format("{}, pass {} of {}", cost.name, pass + 1, passes) : cost.name);
        const Stopwatch watch;
        const Made made = make(pass);
        if (pass == 0)
            first = made.radius;
        add(cost, made, watch.seconds());
        progress.stage("camera");
        Image picture = draw(*made.lights, pass);
        if (pass == 0)
            mean = std::move(picture);
        else
            add_to_mean(mean, picture, pass + 1);
    }
    if (by_rays(plan)) {
        cost.detail["passes"] = passes;
        cost.detail["first_radius"] = first;
    }
    seconds = cost.seconds;
    statistics.stages.push_back(std::move(cost));
    return mean;
}

LightRays light_rays_by(const InScattering* lights, const DirectLight* scene, const Plan& plan) {
    if (!lights && !plan.emitters_by_rays)
        return {};
    return [=, emitters = plan.emitters_by_rays](const PixelRay& r, double end) {
        thread_local RayMedium seen;
        seen.look(scene->field(), r.ray, end);
        Rng rng = lights ? lights->rng(Stream::RayLightPair, r.pixel, r.number)
                         : Rng(Stream::RayLightPair, r.pixel, r.number);
        LightOnRay light;
        if (lights)
            light.scattered = lights->along_ray(seen, rng);
        if (emitters)
            light.emitters = emitters_along_ray(*scene, seen, r.ray, kEmitterPlaces, rng);
        return light;
    };
}

Plan without_scattered_lights(Plan plan) {
    plan.multiple = false;
    for (const Cell cell : {Cell::MM, Cell::SM, Cell::MA})
        plan.needed[static_cast<int>(cell)] = false;
    return plan;
}

// One scattering in smoke alone leaves the camera's rays the peak of the phase function (similar_medium.h), which they
// find again for fire; light from a set needs its peaks as they are.
int bounces_beside_scattered_lights(const Plan& plan) {
    return plan.needs(Cell::MS) ? 2 : 1;
}

void check_scattered_lights(const Shot& shot, const Plan& plan) {
    if (shot.lighting.gather == GatherMethod::RayMarch)
        throw Error(ExitCode::Usage, std::string("lighting.gather: ray_march does not work with scattering.method ") +
                                         name_of(plan.scattering) + "; use cache");
}

}  // namespace brisance
