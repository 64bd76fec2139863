#include "transport/direct_light.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// The probability of a line toward the fire at a vertex in smoke whose optical depth across the fire's radius is less
// than kThickToFire. Deeper in the smoke such lines cost more than they bring (measured), and the path's own segments
// find the same light.
constexpr float kFireLines = 0.25f;
constexpr float kThickToFire = 1.0f;

}  // namespace

DirectLight::DirectLight(const Medium& medium, const TracingSettings& settings, const Surroundings* surroundings)
    : settings_(settings), surroundings_(surroundings), field_(medium), fire_(field_), lines_(field_, settings_) {}

RaySegment DirectLight::segment_along(const Ray& ray) const {
    RaySegment segment{ray, kNoEnd, std::nullopt, std::nullopt};
    if (!surroundings_)
        return segment;
    segment.hit = surroundings_->intersector().first_hit(ray);
    if (segment.hit) {
        segment.end = segment.hit->distance;
        segment.point = surface_point(surroundings_->scene(), *segment.hit, -ray.direction);
    }
    return segment;
}

PathVertex DirectLight::in_smoke(const Ray& ray, const Collision& collision) const {
    return {ray.origin + ray.direction * collision.distance, ray.direction, field_.mean_cosine()};
}

float DirectLight::fire_lines_in_medium(const Collision& c) const {
    const bool thin = settings_.light_sampling && !fire_.empty() &&
                      field_.extinction(c.brick, c.position) * fire_.radius() < kThickToFire;
    return thin ? kFireLines : 0.0f;
}

float DirectLight::fire_lines_on_surface(const PathVertex& vertex) const {
    return settings_.light_sampling && !fire_.empty() && !vertex.only_delta() ? 1.0f : 0.0f;
}

// value / (lines pdf) times the balance heuristic's weight, lines pdf / (lines pdf + pdf of the BSDF): one quotient.
std::optional<DirectLight::LineTowardFire> DirectLight::line_toward_fire(const PathVertex& vertex, float fire_lines,
                                                                         Rng& rng, float least) const {
    const Ray line = vertex.leaving(fire_.sample(vertex.position(), rng));
    const PathVertex::Value scattered = vertex.at(line.direction);
    if (scattered.value == Rgb(0.0f))
        return std::nullopt;
    Rgb weight = scattered.value / float(fire_lines * fire_.pdf(line) + scattered.pdf);
    if (const float brings = luminance(weight); brings < least) {
        if (rng.next() * least >= brings)
            return std::nullopt;
        weight *= least / brings;
    }
    double end = kNoEnd;
    if (surroundings_)
        if (const std::optional<SurfaceHit> hit = surroundings_->intersector().first_hit(line))
            end = hit->distance;
    return LineTowardFire{line, end, weight};
}

Rgb DirectLight::from_fire(const PathVertex& vertex, float fire_lines, Rng& rng) const {
    const std::optional<LineTowardFire> line = line_toward_fire(vertex, fire_lines, rng);
    return line ? line->weight * lines_.follow_line(line->ray, rng, line->end) : Rgb(0.0f);
}

float DirectLight::weight_of_sample(float fire_lines, const Ray& ray, double pdf) const {
    if (fire_lines == 0.0f)
        return 1.0f;
    return static_cast<float>(pdf / (fire_lines * fire_.pdf(ray) + pdf));
}

Rgb DirectLight::from_emitters(const PathVertex& vertex, double choice, Rng& rng, ChosenEmitter* chosen) const {
    const std::optional<EmitterSample> light = surroundings_->emitters().sample(vertex.lit(), choice, rng);
    return light ? from_sample(vertex, *light, rng, chosen) : Rgb(0.0f);
}

Rgb DirectLight::from_emitters_resampled(const PathVertex& vertex, double choice, int candidates, Rng& rng,
                                         ChosenEmitter* chosen) const {
    const Emitters& emitters = surroundings_->emitters();
    const auto parts = static_cast<double>(emitters.choices());
    const double part = std::min(std::floor(choice * parts), parts - 1.0), within = choice * parts - part;
    if (candidates == 1 || emitters.is_far(static_cast<std::size_t>(part)))
        return from_emitters(vertex, choice, rng, chosen);
    std::optional<EmitterSample> kept;
    float of_kept = 0.0f, sum = 0.0f;
    for (int k = 0; k < candidates; ++k) {
        const std::optional<EmitterSample> light =
            emitters.sample(vertex.lit(), (part + (k + within) / candidates) / parts, rng);
        const float brings = light ? luminance(unoccluded(vertex.at(light->direction), *light)) : 0.0f;
        if (!(brings > 0.0f))
            continue;
        sum += brings;
        if (rng.next_double() * sum < brings) {
            kept = light;
            of_kept = brings;
        }
    }
    return kept ? from_sample(vertex, *kept, rng, chosen) * (sum / (of_kept * float(candidates))) : Rgb(0.0f);
}

Rgb DirectLight::unoccluded(const PathVertex::Value& scattered, const EmitterSample& light) const {
    const double weight = light.pdf > 0.0 ? light.pdf / (light.pdf + scattered.pdf) : 1.0;
    return scattered.value * light.weight * float(weight);
}

Rgb DirectLight::from_sample(const PathVertex& vertex, const EmitterSample& light, Rng& rng,
                             ChosenEmitter* chosen) const {
    const PathVertex::Value scattered = vertex.at(light.direction);
    if (scattered.value == Rgb(0.0f))
        return Rgb(0.0f);
    double end = light.distance;
    const bool near = std::isfinite(end);
    const Ray ray = near ? vertex.toward(light.end, end) : vertex.leaving(light.direction);
    if (surroundings_->intersector().occluded(ray, end))
        return Rgb(0.0f);
    if (chosen)
        *chosen = {!near && light.pdf > 0.0, light.direction};
    return unoccluded(scattered, light) * float(lines_.transmittance(ray, end, rng));
}

Rgb DirectLight::at_end(const RaySegment& segment, double pdf, bool delta, const PathVertex* from) const {
    const Emitters& emitters = surroundings_->emitters();
    const dvec3& direction = segment.ray.direction;
    Rgb seen(0.0f);
    double other = 0.0;
    if (segment.hit) {
        seen = segment.point->emission;
        if (seen != Rgb(0.0f) && from && !delta)
            other = emitters.pdf_of_hit(from->lit(), *segment.hit, direction, segment.end);
    } else {
        seen = emitters.background(direction);
        if (seen != Rgb(0.0f) && from && !delta)
            other = emitters.pdf_of_background(direction);
    }
    return other > 0.0 ? seen * float(pdf / (pdf + other)) : seen;
}

}  // namespace brisance
