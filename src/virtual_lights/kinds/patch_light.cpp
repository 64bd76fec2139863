#include "virtual_lights/kinds/patch_light.h"

namespace brisance {

Rgb incident_from_patch(const LightSet& set, const Connection& connection, const PathVertex& vertex, Rng& rng) {
    const VirtualLight& light = set.lights[connection.light];
    const DirectLight& scene = set.scene();
    // Surface beyond the sphere, or in front of it, is not the light's.
    const double distance = glm::length(light.position - vertex.position());
    RaySegment segment{vertex.leaving(connection.direction), 0.0, std::nullopt, std::nullopt};
    segment.hit = scene.surroundings()->intersector().first_hit(segment.ray, distance + light.radius);
    if (!segment.hit || segment.hit->distance < 0.999 * distance - light.radius)
        return Rgb(0.0f);
    segment.end = segment.hit->distance;
    segment.point = surface_point(scene.surroundings()->scene(), *segment.hit, -connection.direction);
    const CoveredHit hit = set.covered(segment);
    for (int i = 0; i < hit.shares.count; ++i) {
        if (hit.shares.light[i] != connection.light)
            continue;
        const double terminated = set.termination_probability(hit, connection.scattered.pdf);
        if (terminated == 0.0)
            break;
        const double transmittance = scene.lines().transmittance(segment.ray, segment.end, rng);
        return connection.scattered.value * set.reflected(hit, i) * float(terminated * transmittance);
    }
    return Rgb(0.0f);
}

}  // namespace brisance
