#include "virtual_lights/kinds/patch_light.h"

#include <optional>

namespace brisance {

namespace {

// The share in the hit that belongs to the connection's light; none: it does not cover the hit.
std::optional<int> share_of(const Connection& connection, const CoveredHit& hit) {
    for (int i = 0; i < hit.shares.count; ++i)
        if (hit.shares.light[i] == connection.light)
            return i;
    return std::nullopt;
}

}  // namespace

void meet_patch(const LightSet& set, const Connection& connection, const PathVertex& vertex, const VisitPatch& visit) {
    const VirtualLight& light = set.lights[connection.light];
    const DirectLight& scene = set.scene();
    // Surface beyond the sphere, or in front of it, is not the light's.
    const double distance = glm::length(light.position - vertex.position());
    RaySegment segment{vertex.leaving(connection.direction), 0.0, std::nullopt, std::nullopt};
    segment.hit = scene.surroundings()->intersector().first_hit(segment.ray, distance + light.radius);
    if (!segment.hit || segment.hit->distance < 0.999 * distance - light.radius)
        return;
    segment.end = segment.hit->distance;
    segment.point = surface_point(scene.surroundings()->scene(), *segment.hit, -connection.direction);
    const CoveredHit hit = set.covered(segment);
    if (!share_of(connection, hit))
        return;
    if (const double terminated = set.ending(hit, connection.scattered.pdf).light; terminated > 0.0)
        visit(hit, terminated);
}

Rgb incident_from_patch(const LightSet& set, const Connection& connection, const PathVertex& vertex, Rng& rng) {
    Rgb out(0.0f);
    meet_patch(set, connection, vertex, [&](const CoveredHit& hit, double terminated) {
        const double transmittance = set.scene().lines().transmittance(hit.segment.ray, hit.segment.end, rng);
        out = connection.scattered.value * set.reflected(hit, *share_of(connection, hit)) *
              float(terminated * transmittance);
    });
    return out;
}

bool patch_is_met(const LightSet& set, const Connection& connection, const PathVertex& vertex) {
    bool met = false;
    meet_patch(set, connection, vertex, [&](const CoveredHit&, double) { met = true; });
    return met;
}

}  // namespace brisance
