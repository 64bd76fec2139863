#include "volumetric_vpls/vpl_sum.h"

#include <cmath>

#include "light_selection/joint_sampling.h"
#include "transport/particles.h"

namespace brisance {

namespace {

// Weight of the importance of a light's box in the target function along rays: a floor, as a few angles may miss the
// light.
constexpr double kByItsBox = 0.1;

// Fraction of the scene's size that is the length of a ray segment standing for a point.
constexpr double kShort = 1e-6;

}  // namespace

VplSum::VplSum(const DirectLight& scene, std::vector<VolumetricVpl> lights, const Bound& bound, int bounces)
    : scene_(scene),
      lights_(std::move(lights)),
      tree_(boxes_of(lights_), scene.field().mean_cosine()),
      bound_(bound),
      bounces_(bounces),
      short_length_(kShort * ball_around(scene).radius) {}

bool VplSum::within_bounces(int order, const VolumetricVpl& light) const {
    return bounces_ < 0 || order + light.scatterings <= bounces_;
}

bool VplSum::occluded(const Ray& ray, double end) const {
    return scene_.surroundings() && scene_.surroundings()->intersector().occluded(ray, end);
}

LightReceiver VplSum::receiver_at(const PathVertex& vertex) const {
    if (!vertex.on_surface())
        return LightReceiver::in_smoke(vertex.position(), vertex.arriving(), short_length_);
    const dvec3& normal = vertex.lit().normal;
    const bool above = glm::dot(normal, vertex.arriving()) <= 0.0;
    return LightReceiver::at(vertex.position(), above ? normal : -normal);
}

double VplSum::target_along(const RayMedium& seen, const LightReceiver& receiver, const VolumetricVpl& light) const {
    const double g = scene_.field().mean_cosine();
    const double shown = shown_along(seen, {light.position, light.direction, light.extinction, bound_.per_metre2()}, g);
    return light.scattered * shown + kByItsBox * importance(bounds_of(light), receiver, g);
}

// Approximate contribution: without colour, visibility and the exact transmittance.
double VplSum::target_at(const PathVertex& vertex, int order, const VolumetricVpl& light) const {
    double w = 0.0;
    const Ray ray = vertex.toward(light.position, w);
    if (!within_bounces(order, light) || !(w > 0.0))
        return 0.0;
    const double phase = phase_about(light.direction, -ray.direction, scene_.field().mean_cosine());
    return light.scattered * luminance(vertex.at(ray.direction).value) * phase * bound_.of(1.0 / (w * w)) *
           guessed_transmittance(light.extinction * w);
}

Rgb VplSum::to_ray(const RayMedium& seen, const VolumetricVpl& light, Rng& rng) const {
    const Segment& camera = seen.segment();
    if (!(camera.length > 0.0))
        return Rgb(0.0f);
    const double g = scene_.field().mean_cosine();
    const AngularDensity angular(light.position, camera, {{light.direction, g}, {-camera.direction, g}});
    const double u = rng.next_double() < 0.5 ? angular.sample(rng) : seen.sample_flight(rng.next_double());
    const double pdf = 0.5 * (angular.pdf(u) + seen.pdf_of_flight(u));
    const Coefficients at_u = seen.coefficients(u);
    const dvec3 offset = camera.at(u) - light.position;
    const double w = glm::length(offset);
    if (at_u.scattering == Rgb(0.0f) || !(w > 0.0) || !(pdf > 0.0))
        return Rgb(0.0f);
    const Ray between{light.position, offset / w};
    if (occluded(between, w))
        return Rgb(0.0f);
    const double phases =
        phase_about(light.direction, between.direction, g) * phase_about(between.direction, -camera.direction, g);
    const double through = seen.transmittance(u) * scene_.lines().transmittance(between, w, rng);
    return light.power * at_u.scattering * float(phases * through * bound_.of(1.0 / (w * w)) / pdf);
}

Rgb VplSum::to_vertex(const PathVertex& vertex, int order, const VolumetricVpl& light, Rng& rng) const {
    double w = 0.0;
    const Ray ray = vertex.toward(light.position, w);
    if (!within_bounces(order, light) || !(w > 0.0))
        return Rgb(0.0f);
    const Rgb value = vertex.at(ray.direction).value;
    if (value == Rgb(0.0f) || occluded(ray, w))
        return Rgb(0.0f);
    const double phase = phase_about(light.direction, -ray.direction, scene_.field().mean_cosine());
    const double through = scene_.lines().transmittance(ray, w, rng);
    return light.power * value * float(phase * through * bound_.of(1.0 / (w * w)));
}

Rgb VplSum::along_ray(const RayMedium& seen, int samples, Rng& rng, SelectionCost* cost) const {
    thread_local std::vector<LightChoice<VolumetricVpl>> choices;
    if (seen.empty())
        return Rgb(0.0f);
    const LightReceiver receiver = receiver_along(seen);
    const auto target = [&](const VolumetricVpl& light) { return target_along(seen, receiver, light); };
    resample_lights<VolumetricVpl>(tree_, lights_, receiver, samples, target, rng, cost, choices);
    Rgb sum(0.0f);
    for (const LightChoice<VolumetricVpl>& c : choices)
        sum += float(c.weight) * to_ray(seen, *c.light, rng);
    return sum;
}

Rgb VplSum::at(const PathVertex& vertex, int order, int samples, Rng& rng, SelectionCost* cost) const {
    thread_local std::vector<LightChoice<VolumetricVpl>> choices;
    if (vertex.only_delta())
        return Rgb(0.0f);
    const auto target = [&](const VolumetricVpl& light) { return target_at(vertex, order, light); };
    resample_lights<VolumetricVpl>(tree_, lights_, receiver_at(vertex), samples, target, rng, cost, choices);
    Rgb sum(0.0f);
    for (const LightChoice<VolumetricVpl>& c : choices)
        sum += float(c.weight) * to_vertex(vertex, order, *c.light, rng);
    return sum;
}

Rgb VplSum::along_ray_from_all(const RayMedium& seen, Rng& rng) const {
    Rgb sum(0.0f);
    for (const VolumetricVpl& light : lights_)
        if (!seen.empty())
            sum += to_ray(seen, light, rng);
    return sum;
}

Rgb VplSum::at_from_all(const PathVertex& vertex, int order, Rng& rng) const {
    Rgb sum(0.0f);
    for (const VolumetricVpl& light : lights_)
        sum += to_vertex(vertex, order, light, rng);
    return sum;
}

}  // namespace brisance
