#include "virtual_lights/kinds/sphere_light.h"

#include "virtual_lights/placement/packing_distance.h"

namespace brisance {

void widen_to_neighbours(LightSet& set) {
    // Of the scene's radius, for a single light.
    constexpr double kSingleRadius = 0.1;
    std::vector<vec3> positions;
    for (const VirtualLight& light : set.lights)
        positions.emplace_back(light.position);
    const std::vector<double> distances = distances_to_nearest(positions, set.settings().sphere_neighbours);
    const double otherwise = kSingleRadius * ball_around(set.scene()).radius;
    for (std::size_t i = 0; i < set.lights.size(); ++i)
        set.lights[i].radius = distances[i] > 0.0 ? distances[i] : otherwise;
}

}  // namespace brisance
