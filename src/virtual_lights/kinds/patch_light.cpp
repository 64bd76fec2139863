#include "virtual_lights/kinds/patch_light.h"

namespace brisance {

namespace {

// Calls visit(hit, share, terminated) where the connection's ray meets surface that the light covers and where paths
// end in part at least.
template <class Visit>
void meet_patch(const LightSet& set, const Connection& connection, const PathVertex& vertex, const Visit& visit) {
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
    for (int i = 0; i < hit.shares.count; ++i) {
        if (hit.shares.light[i] != connection.light)
            continue;
        if (const double terminated = set.ending(hit, connection.scattered.pdf).light; terminated > 0.0)
            visit(hit, i, terminated);
        return;
    }
}

}  // namespace

Rgb incident_from_patch(const LightSet& set, const Connection& connection, const PathVertex& vertex, Rng& rng) {
    Rgb out(0.0f);
    meet_patch(set, connection, vertex, [&](const CoveredHit& hit, int share, double terminated) {
        const double transmittance = set.scene().lines().transmittance(hit.segment.ray, hit.segment.end, rng);
        out = connection.scattered.value * set.reflected(hit, share) * float(terminated * transmittance);
    });
    return out;
}

bool patch_is_met(const LightSet& set, const Connection& connection, const PathVertex& vertex) {
    bool met = false;
    meet_patch(set, connection, vertex, [&](const CoveredHit&, int, double) { met = true; });
    return met;
}

}  // namespace brisance
