#include "ray_lights/ray_lights.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

constexpr double kMostlySeen = 0.99;
// Lights that the tree proposes for one that is asked.
constexpr int kCandidates = 8;
// What its few places may miss, a light is wanted for by its box.
constexpr double kByItsBox = 0.1;

// Of the bricks that hold any smoke [m^3].
double volume_of(const TrackingField& field) {
    std::size_t bricks = 0;
    for (std::size_t b = 0; b < field.bricks().brick_count(); ++b)
        bricks += field.majorant(b) > 0.0f;
    return double(bricks * BrickLattice::kNodes) * std::abs(glm::determinant(dmat3(field.medium().world_from_index)));
}

// How far it is to the nearest light from anywhere in the smoke, on average, were they strewn evenly: lines of a total
// length l in a volume V are as many to an area as l / V, whatever their directions.
double automatic_radius(std::span<const RayLight> lights, const TrackingField& field) {
    double length = 0.0;
    for (const RayLight& light : lights)
        length += light.segment.length;
    return length > 0.0 ? 0.5 * std::sqrt(volume_of(field) / length) : 0.0;
}

std::vector<RayLight> thickened(std::vector<RayLight> lights, double radius, const TrackingField& field) {
    const double r = radius == kAutomaticRadius ? automatic_radius(lights, field) : radius;
    for (RayLight& light : lights)
        light.radius = r;
    return lights;
}

// A phase function's mean cosine once it is blurred over a ball of that sine, about.
double blurred(double g, double sine) {
    const double a = 1.0 - std::min(1.0, std::hypot(1.0 - std::abs(g), sine));
    return g < 0.0 ? -a : a;
}

}  // namespace

RayLightReceiver receiver_along(const SeenMedium& seen) {
    Segment part = seen.segment();
    part.length = seen.sample_flight(kMostlySeen);
    return RayLightReceiver::along(part);
}

RayLightSettings settings_of_pass(RayLightSettings settings, int pass, double first) {
    if (pass == 0)
        return settings;
    settings.radius = first * radius_shrunk(pass, settings.shrink);
    Rng rng(Stream::RayLightPass, settings.seed, static_cast<std::uint64_t>(pass));
    settings.seed = static_cast<std::uint32_t>(rng.next_double() * 0x1p32);
    return settings;
}

RayLights::RayLights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
                     std::span<const RayLightReceiver> receivers)
    : scene_(scene),
      settings_(settings),
      lights_(thickened(
          keep_important(trace_ray_lights(scene, settings, bounces, report_), receivers,
                         static_cast<std::size_t>(settings.count), scene.field().mean_cosine(), settings.seed),
          settings.radius, scene.field())),
      tree_(lights_, scene.field().mean_cosine()) {
    report_.lights = lights_.size();
}

double RayLights::reaches_along(const RayLight& light, double v, Rng& rng) const {
    return light.dimmed ? scene_.lines().transmittance({light.segment.start, light.segment.direction}, v, rng) : 1.0;
}

bool RayLights::occluded(const Ray& ray, double end) const {
    return scene_.surroundings() && scene_.surroundings()->intersector().occluded(ray, end);
}

Rgb RayLights::pair(const SeenMedium& seen, const RayLight& light, Rng& rng) const {
    const Segment& camera = seen.segment();
    const double g = scene_.field().mean_cosine();
    const PairDensity joint(camera, light.segment, g, light.radius);
    PairSample s;
    if (rng.next_double() < 0.5) {
        const std::optional<PairSample> drawn = joint.sample(rng);
        if (!drawn)
            return Rgb(0.0f);
        s = *drawn;
        s.pdf += seen.pdf_of_flight(s.u) * joint.on_light(s.u).pdf(s.v);
    } else {
        s.u = seen.sample_flight(rng.next_double());
        const AngularDensity on_light = joint.on_light(s.u);
        s.v = on_light.sample(rng);
        s.pdf = joint.pdf(s.u, s.v) + seen.pdf_of_flight(s.u) * on_light.pdf(s.v);
    }
    s.pdf *= 0.5;
    const Coefficients at_u = seen.coefficients(s.u);
    const Coefficients at_v = RayProbe(scene_.field(), {light.segment.start, light.segment.direction}).at(s.v);
    if (at_u.scattering == Rgb(0.0f) || at_v.scattering == Rgb(0.0f))
        return Rgb(0.0f);
    const dvec3 from = light.segment.at(s.v), way = camera.at(s.u) - from;
    const double w = glm::length(way);
    if (!(w > 0.0) || !(s.pdf > 0.0))
        return Rgb(0.0f);
    const Ray between{from, way / w};
    if (occluded(between, w))
        return Rgb(0.0f);
    const BallCone cone(between.direction, w, light.radius);
    const double phases = mean_phases(cone, light.segment.direction, -camera.direction, g, rng);
    const double through =
        seen.transmittance(s.u) * reaches_along(light, s.v, rng) * scene_.lines().transmittance(between, w, rng);
    return light.power * at_u.scattering * at_v.scattering * float(phases * through * cone.kernel() / s.pdf);
}

Rgb RayLights::to_surface(const SurfacePoint& point, const Bsdf& bsdf, const dvec3& toward_viewer,
                          const RayLight& light, Rng& rng) const {
    const double g = scene_.field().mean_cosine();
    const AngularDensity density(point.position, light.segment, {{-light.segment.direction, g}}, light.radius);
    const double v = density.sample(rng);
    const Coefficients at_v = RayProbe(scene_.field(), {light.segment.start, light.segment.direction}).at(v);
    if (at_v.scattering == Rgb(0.0f))
        return Rgb(0.0f);
    const dvec3 place = light.segment.at(v), start = point.start_toward(place), way = place - start;
    const double w = glm::length(way);
    if (!(w > 0.0))
        return Rgb(0.0f);
    const Ray ray{start, way / w};
    const BallCone cone(ray.direction, w, light.radius);
    const Rgb scattered = mean_reflected(cone, light.segment.direction, g, point, bsdf, toward_viewer, rng);
    if (scattered == Rgb(0.0f) || occluded(ray, w))
        return Rgb(0.0f);
    const double through = reaches_along(light, v, rng) * scene_.lines().transmittance(ray, w, rng);
    return light.power * at_v.scattering * scattered * float(through * cone.kernel() / density.pdf(v));
}

// The double integral of a pair by a few of its places.
double RayLights::wanted_along(const SeenMedium& seen, const RayLight& light) const {
    constexpr int kPlaces = 3, kAngles = 4;
    const Segment& ray = seen.segment();
    const double g = scene_.field().mean_cosine(), tiny = std::max(1e-9 * ray.length, 0.5 * light.radius);
    const InverseDistanceDensity near(light.segment, ray, light.radius);
    double sum = 0.0;
    for (int i = 0; i < kPlaces; ++i) {
        const double v = near.place((i + 0.5) / kPlaces);
        const dvec3 way = ray.start - light.segment.at(v);
        const double begin = glm::dot(way, ray.direction);
        const dvec3 across = way - begin * ray.direction;
        const double height = std::max(glm::length(across), tiny), first = std::atan2(begin, height);
        const double angle = std::atan2(height * ray.length, height * height + begin * (begin + ray.length));
        double shown = 0.0;
        for (int k = 0; k < kAngles; ++k) {
            const double a = first + (k + 0.5) / kAngles * angle, cosine = std::max(std::cos(a), 1e-12);
            const double u = std::clamp(height * std::sin(a) / cosine - begin, 0.0, ray.length);
            double here = seen.transmittance(u) * guessed_transmittance(light.extinction * height / cosine);
            if (g != 0.0) {
                const dvec3 toward = cosine / height * across + std::sin(a) * ray.direction;
                const double wide = blurred(g, light.radius * cosine / height);
                here *= phase_about(light.segment.direction, toward, wide) * phase_about(toward, -ray.direction, wide);
            }
            shown += here;
        }
        sum += shown * angle / (height * near.pdf(v));
    }
    return sum * light.scattered / (kPlaces * kAngles * light.segment.length);
}

// By its middle, as the tree sees it.
double RayLights::wanted_at(const dvec3& point, const dvec3& normal, const RayLight& light) const {
    return importance(bounds_of(light), RayLightReceiver::at(point, normal), scene_.field().mean_cosine());
}

// Candidates are stratified over the tree; those of one sample lie apart.
template <class Wanted>
void RayLights::choose(const RayLightReceiver& receiver, const Wanted& wanted_of, Rng& rng, RayLightCost* cost,
                       std::vector<Choice>& choices) const {
    choices.clear();
    if (tree_.empty())
        return;
    const int samples = settings_.samples, candidates = samples * kCandidates;
    const double shift = rng.next_double();
    for (int i = 0; i < samples; ++i) {
        double sum = 0.0, target = 0.0;
        const RayLight* chosen = nullptr;
        for (int k = 0; k < kCandidates; ++k) {
            const auto proposed = tree_.choose(receiver, (i + samples * k + shift) / candidates);
            if (!proposed)
                continue;
            const RayLight& light = lights_[proposed->light];
            const double wanted = wanted_of(light), weight = wanted / proposed->probability;
            sum += weight;
            if (weight > 0.0 && rng.next_double() * sum < weight) {
                chosen = &light;
                target = wanted;
            }
            if (cost)
                cost->visited += static_cast<std::uint64_t>(proposed->visited);
        }
        if (chosen)
            choices.push_back({chosen, sum / (target * kCandidates * samples)});
    }
    if (cost)
        cost->pairs += choices.size();
}

Rgb RayLights::along_ray(const SeenMedium& seen, Rng& rng, RayLightCost* cost) const {
    thread_local std::vector<Choice> choices;
    if (seen.empty())
        return Rgb(0.0f);
    const RayLightReceiver receiver = receiver_along(seen);
    const double g = scene_.field().mean_cosine();
    const auto wanted = [&](const RayLight& light) {
        return wanted_along(seen, light) + kByItsBox * importance(bounds_of(light), receiver, g);
    };
    choose(receiver, wanted, rng, cost, choices);
    Rgb sum(0.0f);
    for (const Choice& c : choices)
        sum += float(c.weight) * pair(seen, *c.light, rng);
    return sum;
}

Rgb RayLights::at_surface(const SurfacePoint& point, const Bsdf& bsdf, const dvec3& toward_viewer, Rng& rng,
                          RayLightCost* cost) const {
    thread_local std::vector<Choice> choices;
    const bool above = glm::dot(point.frame.normal, toward_viewer) >= 0.0;
    const dvec3 normal = above ? point.frame.normal : -point.frame.normal;
    const auto wanted = [&](const RayLight& light) { return wanted_at(point.position, normal, light); };
    choose(RayLightReceiver::at(point.position, normal), wanted, rng, cost, choices);
    Rgb sum(0.0f);
    for (const Choice& c : choices)
        sum += float(c.weight) * to_surface(point, bsdf, toward_viewer, *c.light, rng);
    return sum;
}

Rgb RayLights::along_ray_from_all(const SeenMedium& seen, Rng& rng) const {
    Rgb sum(0.0f);
    for (const RayLight& light : lights_)
        if (!seen.empty())
            sum += pair(seen, light, rng);
    return sum;
}

Rgb RayLights::at_surface_from_all(const SurfacePoint& point, const Bsdf& bsdf, const dvec3& toward_viewer,
                                   Rng& rng) const {
    Rgb sum(0.0f);
    for (const RayLight& light : lights_)
        sum += to_surface(point, bsdf, toward_viewer, light, rng);
    return sum;
}

}  // namespace brisance
