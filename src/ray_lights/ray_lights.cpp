#include "ray_lights/ray_lights.h"

#include <algorithm>
#include <cmath>

#include "light_selection/joint_sampling.h"
#include "light_selection/progressive_radius.h"
#include "light_selection/resample_lights.h"
#include "light_selection/thin_lights.h"

namespace brisance {

namespace {

// Weight of the importance of a light's box in the target function along rays: a floor, as a few points may miss the
// light.
constexpr double kByItsBox = 0.1;

// The mean distance to the nearest light from a random point in the smoke, if the lights were distributed uniformly:
// lines of total length l in a volume V cross a unit area perpendicular to them l / V times, whatever their directions.
double automatic_radius(std::span<const RayLight> lights, const TrackingField& field) {
    double length = 0.0;
    for (const RayLight& light : lights)
        length += light.segment.length;
    return length > 0.0 ? 0.5 * std::sqrt(field.smoke_volume() / length) : 0.0;
}

std::vector<RayLight> thickened(std::vector<RayLight> lights, double radius, const TrackingField& field) {
    const double r = radius == kAutomaticRadius ? automatic_radius(lights, field) : radius;
    for (RayLight& light : lights)
        light.radius = r;
    return lights;
}

ReceiverLobes lobes_for(const RayLight& light, const ReceiverLobes& lobes) {
    return light.from_smoke ? lobes : ReceiverLobes(lobes.whole);
}

}  // namespace

RayLightSettings settings_of_pass(RayLightSettings settings, int pass, double first) {
    if (pass == 0)
        return settings;
    settings.radius = first * radius_shrunk(pass, settings.radius_reduction);
    Rng rng(Stream::RayLightPass, settings.seed, static_cast<std::uint64_t>(pass));
    settings.seed = static_cast<std::uint32_t>(rng.next_double() * 0x1p32);
    return settings;
}

RayLights::RayLights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
                     std::span<const LightReceiver> receivers)
    : InScattering(settings.seed),
      scene_(scene),
      settings_(settings),
      sampling_(pair_sampling(settings.sampling)),
      lights_(thickened(thin_lights(trace_ray_lights(scene, settings, bounces, report_), receivers,
                                    {static_cast<std::size_t>(settings.count), scene.field().mean_cosine(),
                                     settings.roulette_visibility ? scene.occluders() : nullptr,
                                     Stream::RayLightRoulette, settings.seed}),
                        settings.radius, scene.field())),
      tree_(boxes_of(lights_), scene.field().mean_cosine()) {
    report_.lights = lights_.size();
}

double RayLights::reaches_along(const RayLight& light, double v, Rng& rng) const {
    return light.dimmed ? scene_.lines().transmittance({light.segment.start, light.segment.direction}, v, rng) : 1.0;
}

bool RayLights::occluded(const Ray& ray, double end) const {
    return scene_.surroundings() && scene_.surroundings()->intersector().occluded(ray, end);
}

Rgb RayLights::pair(const RayMedium& seen, const RayLight& light, Rng& rng) const {
    const Segment& camera = seen.segment();
    const double g = scene_.field().mean_cosine();
    const std::optional<PairSample> drawn = sampling_.draw(seen, light, g, rng);
    if (!drawn)
        return Rgb(0.0f);
    const PairSample& s = *drawn;
    const Coefficients at_u = seen.coefficients(s.u);
    const Coefficients at_v = RayProbe(scene_.field(), {light.segment.start, light.segment.direction}).at(s.v);
    if (at_u.scattering == Rgb(0.0f) || at_v.scattering == Rgb(0.0f))
        return Rgb(0.0f);
    const dvec3 from = light.segment.at(s.v), offset = camera.at(s.u) - from;
    const double w = glm::length(offset);
    if (!(w > 0.0) || !(s.pdf > 0.0))
        return Rgb(0.0f);
    const Ray between{from, offset / w};
    if (occluded(between, w))
        return Rgb(0.0f);
    const BallCone cone(between.direction, w, light.radius);
    const double phases = mean_phases(cone, light.segment.direction, -camera.direction, g, rng);
    const double through =
        seen.transmittance(s.u) * reaches_along(light, s.v, rng) * scene_.lines().transmittance(between, w, rng);
    return light.power * at_u.scattering * at_v.scattering * float(phases * through * cone.kernel() / s.pdf);
}

Rgb RayLights::to_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer,
                          const RayLight& light, Rng& rng) const {
    const double g = scene_.field().mean_cosine();
    const auto [v, pdf] = sampling_.draw_on_light(point.position, light, g, rng);
    const Coefficients at_v = RayProbe(scene_.field(), {light.segment.start, light.segment.direction}).at(v);
    if (at_v.scattering == Rgb(0.0f))
        return Rgb(0.0f);
    const dvec3 source = light.segment.at(v), start = point.start_toward(source), offset = source - start;
    const double w = glm::length(offset);
    if (!(w > 0.0))
        return Rgb(0.0f);
    const Ray ray{start, offset / w};
    const BallCone cone(ray.direction, w, light.radius);
    const Rgb scattered =
        mean_reflected(cone, light.segment.direction, g, point, lobes_for(light, lobes), toward_viewer, rng);
    if (scattered == Rgb(0.0f) || occluded(ray, w))
        return Rgb(0.0f);
    const double through = reaches_along(light, v, rng) * scene_.lines().transmittance(ray, w, rng);
    return light.power * at_v.scattering * scattered * float(through * cone.kernel() / pdf);
}

// The double integral of a pair, approximated with a few points on the light.
double RayLights::target_along(const RayMedium& seen, const RayLight& light) const {
    constexpr int kSamples = 3;
    const double g = scene_.field().mean_cosine();
    const InverseDistanceDensity near(light.segment, seen.segment(), light.radius);
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        const double v = near.quantile((i + 0.5) / kSamples);
        sum +=
            shown_along(seen, {light.segment.at(v), light.segment.direction, light.extinction, 0.0, light.radius}, g) /
            near.pdf(v);
    }
    return sum * light.scattered / (kSamples * light.segment.length);
}

// Importance of its box, as for the tree.
double RayLights::target_at(const dvec3& point, const dvec3& normal, const RayLight& light) const {
    return importance(bounds_of(light), LightReceiver::at(point, normal), scene_.field().mean_cosine());
}

Rgb RayLights::along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost) const {
    thread_local std::vector<LightChoice<RayLight>> choices;
    if (seen.empty())
        return Rgb(0.0f);
    const LightReceiver receiver = receiver_along(seen);
    const double g = scene_.field().mean_cosine();
    const auto target = [&](const RayLight& light) {
        return target_along(seen, light) + kByItsBox * importance(bounds_of(light), receiver, g);
    };
    resample_lights<RayLight>(tree_, lights_, receiver, settings_.samples, target, rng, cost, choices);
    Rgb sum(0.0f);
    for (const LightChoice<RayLight>& c : choices)
        sum += float(c.weight) * pair(seen, *c.light, rng);
    return sum;
}

Rgb RayLights::at_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                          SelectionCost* cost) const {
    thread_local std::vector<LightChoice<RayLight>> choices;
    const bool above = glm::dot(point.frame.normal, toward_viewer) >= 0.0;
    const dvec3 normal = above ? point.frame.normal : -point.frame.normal;
    const bool from_all = !lobes.shared || lobes.whole.base_albedo(toward_viewer) != Rgb(0.0f);
    const auto target = [&](const RayLight& light) {
        return from_all || light.from_smoke ? target_at(point.position, normal, light) : 0.0;
    };
    resample_lights<RayLight>(tree_, lights_, LightReceiver::at(point.position, normal), settings_.samples, target, rng,
                              cost, choices);
    Rgb sum(0.0f);
    for (const LightChoice<RayLight>& c : choices)
        sum += float(c.weight) * to_surface(point, lobes, toward_viewer, *c.light, rng);
    return sum;
}

Rgb RayLights::along_ray_from_all(const RayMedium& seen, Rng& rng) const {
    Rgb sum(0.0f);
    for (const RayLight& light : lights_)
        if (!seen.empty())
            sum += pair(seen, light, rng);
    return sum;
}

Rgb RayLights::at_surface_from_all(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer,
                                   Rng& rng) const {
    Rgb sum(0.0f);
    for (const RayLight& light : lights_)
        sum += to_surface(point, lobes, toward_viewer, light, rng);
    return sum;
}

}  // namespace brisance
