#include "virtual_lights/kinds/sphere_light.h"

#include <algorithm>
#include <cmath>

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
        set.lights[i].radius = set.settings().sphere_scale * (distances[i] > 0.0 ? distances[i] : otherwise);
}

SphereTechniques::SphereTechniques(SphereSampling sampling, int samples, bool lobed_light) {
    switch (sampling) {
        case SphereSampling::Cone:
            cone = samples;
            break;
        case SphereSampling::Vertex:
            vertex = samples;
            break;
        case SphereSampling::Light:
            light = samples;
            break;
        case SphereSampling::Combined:
            vertex = samples / 4;
            light = lobed_light ? samples / 4 : 0;
            cone = samples - vertex - light;
    }
}

double LightLobe::pdf(const dvec3& leaving) const {
    if (bsdf_)
        return bsdf_->pdf(light_.toward_source, leaving);
    return std::max(0.0, glm::dot(light_.frame.normal, leaving)) / std::numbers::pi;
}

std::optional<dvec3> LightLobe::sample(Rng& rng) const {
    const double x = rng.next_double(), y = rng.next_double();
    if (!bsdf_) {
        const double radius = std::sqrt(x), azimuth = 2.0 * std::numbers::pi * y;
        return light_.frame.world_from_local(
            {radius * std::cos(azimuth), radius * std::sin(azimuth), std::sqrt(1.0 - x)});
    }
    const std::optional<BsdfSample> drawn = bsdf_->sample(light_.toward_source, {x, y, rng.next_double()});
    if (!drawn || drawn->delta)
        return std::nullopt;
    return drawn->wi;
}

}  // namespace brisance
