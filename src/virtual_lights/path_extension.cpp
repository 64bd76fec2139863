// Path extension: the light that virtual lights hold where a ray ends, and how the path continues from there.
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

// Points on every segment through smoke at which lamps are sampled.
constexpr int kLampPlaces = 2;

}  // namespace

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
