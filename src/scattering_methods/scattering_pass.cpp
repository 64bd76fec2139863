#include "scattering_methods/scattering_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "camera_rays/integrate.h"
#include "core/stopwatch.h"
#include "transport/emitters_along_ray.h"

namespace brisance {

namespace {

// Camera rays, along a side of the picture, that represent all of them when lights are thinned out.
constexpr int kReceivers = 12;

// Points on every ray of the camera at which emitters are sampled.
constexpr int kEmitterPoints = 16;

// What is lit: the smoke on some of the camera's rays, and the surfaces behind it.
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

// What one pass cost, after others: counts add up.
void add(StageCost& to, const MadeInScattering& pass, double seconds) {
    to.seconds += seconds;
    to.bytes = std::max(to.bytes, pass.bytes);
    for (const auto& [key, value] : pass.detail.items()) {
        const bool counts = value.is_number_unsigned() && to.detail.contains(key);
        to.detail[key] =
            counts ? nlohmann::ordered_json(value.get<std::uint64_t>() + to.detail[key].get<std::uint64_t>()) : value;
    }
}

}  // namespace

Image mean_of_passes(const ScatteringMethod& method, const ScatteringMethodSettings& settings, int bounces,
                     const DirectLight& scene, const Camera& camera, const DrawPass& draw, double& seconds,
                     Statistics& statistics, Progress& progress) {
    std::vector<LightReceiver> receivers;
    if (method.thins_lights)
        receivers = receivers_of(scene, camera);
    InScatteringRequest request{scene, bounces, camera.eye_local(), receivers};
    StageCost cost{method.product + " (MM, SM)", 0.0, 0, {}};
    const int passes = method.passes(settings);
    Image mean;
    for (; request.pass < passes; ++request.pass) {
        progress.stage(passes > 1 ? fmt::format("{}, pass {} of {}", cost.name, request.pass + 1, passes) : cost.name);
        const Stopwatch watch;
        const MadeInScattering made = method.make(request, settings);
        if (request.pass == 0)
            request.first_radius = made.radius;
        add(cost, made, watch.seconds());
        progress.stage("camera");
        Image picture = draw(*made.estimator, request.pass);
        if (request.pass == 0)
            mean = std::move(picture);
        else
            add_to_mean(mean, picture, request.pass + 1);
    }
    cost.detail["passes"] = passes;
    if (request.first_radius > 0.0)
        cost.detail["first_radius"] = request.first_radius;
    seconds = cost.seconds;
    statistics.stages.push_back(std::move(cost));
    return mean;
}

LightRays light_rays_by(const InScattering* estimator, const DirectLight* scene, const SourceField& field,
                        float emitters, const ManyLightsOnRay& many_lights) {
    if (!estimator && emitters == 0.0f && !many_lights)
        return {};
    return [=, &field](const PixelRay& r, double end) {
        thread_local RayMedium seen;
        seen.look(scene->field(), r.ray, end);
        Rng rng = estimator ? estimator->rng(Stream::RayLightPair, r.pixel, r.number)
                            : Rng(Stream::RayLightPair, r.pixel, r.number);
        LightOnRay light;
        if (estimator)
            light.scattered = estimator->along_ray(seen, rng);
        if (emitters > 0.0f) {
            thread_local StepDensity guide;
            guide_by_emitters(field, r.ray, end, guide);
            light.emitters = emitters * emitters_along_ray(*scene, seen, r.ray, kEmitterPoints, rng, &guide);
        }
        if (many_lights)
            many_lights(seen, r, light);
        return light;
    };
}

}  // namespace brisance
