// Asking virtual lights themselves: one of them, one of several, or all.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "virtual_lights/photon_lights.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

namespace {

constexpr double kPi = std::numbers::pi;

// The end of the way to a sphere's middle that is not looked at, of its radius.
constexpr double kLastPart = 1e-3;

// How many of a sphere's directions are drawn by whom.
struct Techniques {
    int cone, receiver, light;

    Techniques(int samples, bool glossy_light)
        : cone(samples), receiver(samples / 4), light(glossy_light ? samples / 4 : 0) {
        cone -= receiver + light;
    }
};

}  // namespace

// A light, a direction toward it and the density of the two; what would arrive there past nothing.
struct VirtualLights::Candidate {
    std::size_t light = 0;
    dvec3 direction{0.0};
    double density = 0.0;
    Rgb sent{0.0f};
    PathVertex::Value scattered;
    double target = 0.0;  // luminance of what is scattered

    double weight() const { return density > 0.0 ? target / density : 0.0; }
};

// The way to the middle of a light.
struct VirtualLights::Clearance {
    Ray ray;
    double distance = 0.0;
    bool clear = false;
};

VirtualLights::Clearance VirtualLights::clearance(const PathVertex& place, const VirtualLight& light) const {
    Clearance out;
    out.ray = place.toward(light.position + kAboveSurface * light.radius * light.frame.normal, out.distance);
    out.clear =
        out.distance > 0.0 && !scene_.surroundings()->intersector().occluded(out.ray, (1.0 - kLastPart) * out.distance);
    return out;
}

Rgb VirtualLights::from_lights(const PathVertex& place, Rng& rng) const {
    if (settings_.sampling == LightSampling::Resampled)
        return from_resampled(place, rng);
    if (settings_.sampling == LightSampling::All) {
        Rgb sum(0.0f);
        for (std::size_t light = 0; light < lights_.size(); ++light)
            sum += from_light(place, {light, 1.0}, rng);
        return sum;
    }
    const std::optional<LightTree::Choice> choice = choice_.choose(place.lit(), rng.next_double());
    return choice ? from_light(place, *choice, rng) : Rgb(0.0f);
}

Rgb VirtualLights::from_light(const PathVertex& place, const LightTree::Choice& choice, Rng& rng) const {
    switch (settings_.kind) {
        case VirtualLightKind::Sphere:
            return from_sphere(place, choice, rng);
        case VirtualLightKind::Point:
            return from_point(place, choice, rng);
        case VirtualLightKind::Patch:
            break;
    }
    return from_patch(place, choice, rng);
}

Rgb VirtualLights::radiance(const VirtualLight& light, const dvec3& toward) const {
    return light.profile >= 0 ? profiles_.radiance(light, toward)
                              : light.irradiance * light.material.base_colour / std::numbers::pi_v<float>;
}

// Radiance of the light's own material, times its area and the cosine to its normal [W/sr].
Rgb VirtualLights::sent(const VirtualLight& light, const dvec3& toward) const {
    if (settings_.flux == LightFlux::Own)
        return reflected_flux(light, toward);
    const double cosine = glm::dot(light.frame.normal, toward);
    return cosine > 0.0 ? radiance(light, toward) * float(cosine * light.area) : Rgb(0.0f);
}

// The bound holds the light's cosine over squared distance; the place's cosine belongs to its BSDF.
Rgb VirtualLights::sent_by_point(const VirtualLight& light, const PathVertex& place, const dvec3& direction) const {
    const dvec3 way = light.position - place.position();
    const double square = glm::dot(way, way), cosine = -glm::dot(light.frame.normal, direction);
    if (!(cosine > 0.0) || !(square > 0.0))
        return Rgb(0.0f);
    const double kept = std::min(1.0, settings_.point_bound * square / cosine);
    return sent(light, -direction) * float(kept / square);
}

Rgb VirtualLights::from_point(const PathVertex& place, const LightTree::Choice& choice, Rng& rng) const {
    const VirtualLight& light = lights_[choice.light];
    const dvec3 direction = glm::normalize(light.position - place.position());
    const Rgb reflected = sent_by_point(light, place, direction);
    const Rgb scattered = reflected == Rgb(0.0f) ? Rgb(0.0f) : reflected * place.at(direction).value;
    if (scattered == Rgb(0.0f))
        return scattered;
    const Clearance way = clearance(place, light);
    if (!way.clear)
        return Rgb(0.0f);
    return scattered * float(scene_.lines().transmittance(way.ray, way.distance, rng) / choice.probability);
}

// What the light reflects leaves a ball of its radius, evenly over its section, seen or not seen as its middle is
// (Hasan et al., Virtual Spherical Lights for Many-Light Rendering of Glossy Scenes, 2009). Directions come from the
// ball's cone, from the place's BSDF and from that of a light of one photon, by the balance heuristic.
Rgb VirtualLights::from_sphere(const PathVertex& place, const LightTree::Choice& choice, Rng& rng) const {
    const VirtualLight& light = lights_[choice.light];
    const Clearance way = clearance(place, light);
    if (!way.clear)
        return Rgb(0.0f);
    std::optional<Bsdf> glossy;
    if (settings_.flux == LightFlux::Own && needs_energy_tables(light.material))
        glossy.emplace(light.material, light.frame);
    const Techniques draws(settings_.sphere_samples, glossy.has_value());
    Rgb sum(0.0f);
    const auto add = [&](const dvec3& direction) {
        const PathVertex::Value scattered = place.at(direction);
        const Rgb through = scattered.value * sent(light, -direction);
        if (through == Rgb(0.0f))
            return;
        double density = draws.cone * pdf_toward(light, place.lit(), direction) + draws.receiver * scattered.pdf;
        if (draws.light > 0)
            density += draws.light * glossy->pdf(light.toward_source, -direction);
        sum += through / float(density);
    };
    for (int i = 0; i < draws.cone; ++i)
        add(sample_toward(light, place.lit(), rng));
    for (int i = 0; i < draws.receiver; ++i)
        if (const std::optional<PathVertex::Sample> s = place.sample(rng);
            s && !s->delta && leads_into(light, place.lit(), s->wi))
            add(s->wi);
    for (int i = 0; i < draws.light; ++i) {
        const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
        if (const std::optional<BsdfSample> s = glossy->sample(light.toward_source, {x, y, z});
            s && !s->delta && leads_into(light, place.lit(), -s->wi))
            add(-s->wi);
    }
    const double seen = scene_.lines().transmittance(way.ray, way.distance, rng);
    return sum * float(seen / (kPi * light.radius * light.radius * choice.probability));
}

Rgb VirtualLights::from_patch(const PathVertex& place, const LightTree::Choice& choice, Rng& rng) const {
    const VirtualLight& light = lights_[choice.light];
    const dvec3 direction = sample_toward(light, place.lit(), rng);
    const PathVertex::Value scattered = place.at(direction);
    if (scattered.value == Rgb(0.0f))
        return Rgb(0.0f);
    const double pdf = choice.probability * pdf_toward(light, place.lit(), direction);
    const double density = draws_rays(settings_.sampling) ? pdf + scattered.pdf : pdf;
    if (!(density > 0.0))
        return Rgb(0.0f);
    return along_to_patch(place, choice.light, direction, scattered, rng) / float(density);
}

// What the light holds of the surface that a ray toward its sphere meets, scattered at the place.
Rgb VirtualLights::along_to_patch(const PathVertex& place, std::size_t index, const dvec3& direction,
                                  const PathVertex::Value& scattered, Rng& rng) const {
    const VirtualLight& light = lights_[index];
    // What lies beyond the sphere, or before it, is not the light's.
    const double distance = glm::length(light.position - place.position());
    RaySegment segment{place.leaving(direction), 0.0, std::nullopt, std::nullopt};
    segment.hit = scene_.surroundings()->intersector().first_hit(segment.ray, distance + light.radius);
    if (!segment.hit || segment.hit->distance < 0.999 * distance - light.radius)
        return Rgb(0.0f);
    segment.end = segment.hit->distance;
    segment.point = surface_point(scene_.surroundings()->scene(), *segment.hit, -direction);
    const Seen seen = seen_by(segment);
    for (int i = 0; i < seen.shares.count; ++i) {
        if (seen.shares.light[i] != index)
            continue;
        const double believed = termination_probability(seen, scattered.pdf);
        if (believed == 0.0)
            break;
        const double through = scene_.lines().transmittance(segment.ray, segment.end, rng);
        return scattered.value * reflected(seen, i) * float(believed * through);
    }
    return Rgb(0.0f);
}

// Resampled importance sampling, a reservoir of one (J. Talbot, D. Cline, P. Egbert, Importance Resampling for Global
// Illumination, EGSR 2005): the first pass of ReSTIR (B. Bitterli et al., Spatiotemporal Reservoir Resampling for
// Real-Time Ray Tracing with Dynamic Direct Lighting, SIGGRAPH 2020), without reuse from other places or frames.
// Candidates are a light by power and a direction toward it; the target is what it would send there past nothing. Where
// that is 0 nothing is sent, so that the mean is that of asking one light.
Rgb VirtualLights::from_resampled(const PathVertex& place, Rng& rng) const {
    Candidate kept;
    double sum = 0.0;
    for (int i = 0; i < settings_.resampling_candidates; ++i) {
        const Candidate drawn = candidate(place, rng);
        if (!(drawn.weight() > 0.0))
            continue;
        sum += drawn.weight();
        if (rng.next_double() * sum < drawn.weight())
            kept = drawn;
    }
    if (!(sum > 0.0))
        return Rgb(0.0f);
    const auto weight = static_cast<float>(sum / (settings_.resampling_candidates * kept.target));
    if (settings_.kind == VirtualLightKind::Patch)
        return weight * along_to_patch(place, kept.light, kept.direction, kept.scattered, rng);
    const Clearance way = clearance(place, lights_[kept.light]);
    if (!way.clear)
        return Rgb(0.0f);
    const double seen = scene_.lines().transmittance(way.ray, way.distance, rng);
    return kept.scattered.value * kept.sent * (weight * float(seen));
}

VirtualLights::Candidate VirtualLights::candidate(const PathVertex& place, Rng& rng) const {
    Candidate out;
    const std::optional<LightTree::Choice> choice = choice_.choose(place.lit(), rng.next_double());
    if (!choice)
        return out;
    const VirtualLight& light = lights_[choice->light];
    out.light = choice->light;
    out.density = choice->probability;
    if (settings_.kind == VirtualLightKind::Point) {
        out.direction = glm::normalize(light.position - place.position());
        out.sent = sent_by_point(light, place, out.direction);
    } else {
        out.direction = sample_toward(light, place.lit(), rng);
        out.density *= pdf_toward(light, place.lit(), out.direction);
    }
    if (settings_.kind == VirtualLightKind::Sphere)
        out.sent = sent(light, -out.direction) / float(kPi * light.radius * light.radius);
    if (settings_.kind == VirtualLightKind::Patch)  // Lambert surfaces take the colour of the place that is met
        out.sent = light.profile >= 0 ? profiles_.radiance(light, -out.direction) : light.irradiance;
    if (out.sent == Rgb(0.0f))
        return out;
    out.scattered = place.at(out.direction);
    out.target = luminance(out.scattered.value) * luminance(out.sent);
    return out;
}

}  // namespace brisance
