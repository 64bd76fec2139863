// Along a ray: what virtual lights hold where it ends, and how the path goes on from there.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "transport/emitters_along_ray.h"
#include "transport/roulette.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

namespace {

bool goes_straight_on(const PathVertex& place, const PathVertex::Sample& turn) {
    return turn.delta && glm::dot(turn.wi, place.arriving()) > 1.0 - 1e-12;
}

// On every segment through smoke, where lamps are asked for.
constexpr int kLampPlaces = 2;

// A base colour in place of another.
Rgb recoloured(const Rgb& to, const Rgb& from) {
    return {from.x > 0.0f ? to.x / from.x : 0.0f, from.y > 0.0f ? to.y / from.y : 0.0f,
            from.z > 0.0f ? to.z / from.z : 0.0f};
}

}  // namespace

LightShares VirtualLights::shares_at(const SurfaceHit& hit, const SurfacePoint& point) const {
    if (settings_.flux != LightFlux::Gathered || !holds_light(point.material))
        return {};
    const int material = scene_.surroundings()->scene().meshes[hit.mesh].material;
    return cover_.shares(point.position, lit_normal(point), material);
}

bool VirtualLights::hold_base(const SurfaceHit& hit, const SurfacePoint& point) const {
    return settings_.flux == LightFlux::Own ? holds_light(point.material) && !lights_.empty()
                                            : speaking_for(hit, point) > 0;
}

VirtualLights::Seen VirtualLights::seen_by(const RaySegment& segment) const {
    return {segment, shares_at(*segment.hit, *segment.point)};
}

// What one of the lights adds to the radiance seen.
Rgb VirtualLights::reflected(const Seen& seen, int share) const {
    const VirtualLight& light = lights_[seen.shares.light[share]];
    const SurfaceMaterial& there = seen.segment.point->material;
    if (light.profile < 0)
        return light.irradiance * there.base_colour * (seen.shares.weight[share] / std::numbers::pi_v<float>);
    const Rgb radiance = seen.shares.weight[share] * profiles_.radiance(light, -seen.segment.ray.direction);
    const bool metal = there.metallic == 1.0f && light.material.metallic == 1.0f;
    return metal ? radiance * recoloured(there.base_colour, light.material.base_colour) : radiance;
}

// How far the lights are believed, 0..1: by how many of them would lie in the footprint of the ray.
double VirtualLights::termination_probability(const Seen& seen, double pdf) const {
    if (settings_.flux == LightFlux::Own)  // photons have put lights wherever light can be held
        return holds_light(seen.segment.point->material) ? 1.0 : 0.0;
    if (seen.shares.count == 0)
        return 0.0;
    if (!settings_.extension)
        return 1.0;  // spheres and points have been asked for all that such places reflect
    double area = 0.0;
    for (int i = 0; i < seen.shares.count; ++i)
        area += seen.shares.weight[i] * lights_[seen.shares.light[i]].area;
    const RaySegment& segment = seen.segment;
    const double cosine = std::abs(glm::dot(segment.point->geometric_normal, segment.ray.direction));
    const double n = segment.end * segment.end / (pdf * cosine * area);
    if (!(n < settings_.n_max))  // pdf * cosine of 0 as well
        return 1.0;
    return std::clamp((n - settings_.n_min) / (settings_.n_max - settings_.n_min), 0.0, 1.0);
}

// All lights that speak for the place where a ray ends which `place` drew: their radiance, each its share.
Rgb VirtualLights::at_end_of_ray(const PathVertex& place, const Seen& seen, double pdf) const {
    Rgb sum(0.0f);
    if (!draws_rays(settings_.sampling))
        return sum;
    for (int i = 0; i < seen.shares.count; ++i) {
        const std::size_t light = seen.shares.light[i];
        const double other = choice_.by_lights()
                                 ? choice_.probability(place.lit(), light) *
                                       pdf_toward(lights_[light], place.lit(), seen.segment.ray.direction)
                                 : 0.0;
        sum += reflected(seen, i) * float(pdf / (pdf + other));
    }
    return sum;
}

Rgb VirtualLights::lamps_on(const RaySegment& segment, Rng& rng) const {
    thread_local RayMedium seen;
    seen.look(scene_.field(), segment.ray, segment.end);
    return emitters_along_ray(scene_, seen, segment.ray, kLampPlaces, rng);
}

// The place itself asks for what surfaces reflect toward it; places along an extended path for everything.
Rgb VirtualLights::shade(const PathVertex& asking, Rng& rng, int* vertices, Panes panes) const {
    Rgb sum(0.0f), throughput(1.0f);
    if (!shines_)
        return sum;
    PathVertex place = asking;
    float light_lines = 0.0f;
    bool lit_before = true;  // the asking place, by the medium along this segment
    // Smoke is lit all along segments: where they collide hardly ever is in the beam of a lamp that is near.
    const bool lamps_along = scene_.has_emitters() && aims_at_lamps(scene_) && !scene_.field().bricks().empty();
    for (int order = 0; survives(throughput, 1.0f, order > kManyScatterings, rng); ++order) {
        if (vertices)
            ++*vertices;
        if (asks_lights() && !place.only_delta())
            sum += throughput * from_lights(place, rng);
        if (light_lines > 0.0f && (light_lines == 1.0f || rng.next() < light_lines))
            sum += throughput * scene_.from_fire(place, light_lines, rng);
        if (order > 0 && scene_.has_emitters() && !place.only_delta() && !(lamps_along && !place.on_surface()))
            sum += throughput * scene_.from_emitters(place, rng);
        const std::optional<PathVertex::Sample> turn = place.sample(rng);
        if (!turn)
            break;
        const RaySegment segment = scene_.segment_along(place.leaving(turn->wi));
        throughput *= turn->weight;
        lit_before = order == 0 || (lit_before && panes == Panes::Asked && goes_straight_on(place, *turn));
        std::optional<Collision> collision;
        if (!lit_before) {
            if (lamps_along)
                sum += throughput * lamps_on(segment, rng);
            const LineResult line = scene_.lines().follow_path(segment.ray, rng, segment.end);
            collision = line.collision;
            if (line.radiance != Rgb(0.0f))
                sum += throughput * line.radiance *
                       (turn->delta ? 1.0f : scene_.share_of_sample(light_lines, segment.ray, turn->pdf));
        } else if (segment.hit || order > 0) {
            throughput *= float(scene_.lines().transmittance(segment.ray, segment.end, rng));
        }
        if (order > 0 && !collision && !(lamps_along && !place.on_surface()))
            sum += throughput * scene_.at_end(segment, turn->pdf, turn->delta, &place);
        if (collision) {
            place = scene_.in_smoke(segment.ray, *collision);
            throughput *= scene_.field().albedo(collision->brick, collision->position);
            light_lines = scene_.lines_in_smoke(*collision);
            continue;
        }
        if (!segment.hit)
            break;
        if (!turn->delta) {
            const Seen seen = seen_by(segment);
            const auto believed = static_cast<float>(termination_probability(seen, turn->pdf));
            if (believed > 0.0f)
                sum += throughput * believed * at_end_of_ray(place, seen, turn->pdf);
            throughput *= 1.0f - believed;
        }
        place = PathVertex(*segment.point, segment.ray.direction);
        light_lines = scene_.lines_on_surface(place);
    }
    return sum;
}

}  // namespace brisance
