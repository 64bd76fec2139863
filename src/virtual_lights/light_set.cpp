#include "virtual_lights/light_set.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

// Ratio of base colours, 0 where a light has none.
Rgb recoloured(const Rgb& to, const Rgb& from) {
    return {from.x > 0.0f ? to.x / from.x : 0.0f, from.y > 0.0f ? to.y / from.y : 0.0f,
            from.z > 0.0f ? to.z / from.z : 0.0f};
}

}  // namespace

LightShares LightSet::shares_at(const SurfaceHit& hit, const SurfacePoint& point) const {
    if (!holds_light(point.material))
        return {};
    const int material = scene_.surroundings()->scene().meshes[hit.mesh].material;
    return partition.shares(point.position, lit_normal(point), material);
}

Rgb LightSet::radiance(const VirtualLight& light, const dvec3& toward) const {
    return light.profile >= 0 ? profiles.radiance(light, toward)
                              : light.irradiance * light.material.base_colour / std::numbers::pi_v<float>;
}

// Lambert surfaces take their colour from the hit, so that textures stay sharp.
Rgb LightSet::reflected(const CoveredHit& hit, int share) const {
    const VirtualLight& light = lights[hit.shares.light[share]];
    const SurfaceMaterial& there = hit.segment.point->material;
    if (light.profile < 0)
        return light.irradiance * there.base_colour * (hit.shares.weight[share] / std::numbers::pi_v<float>);
    const Rgb radiance = hit.shares.weight[share] * profiles.radiance(light, -hit.segment.ray.direction);
    const bool metal = there.metallic == 1.0f && light.material.metallic == 1.0f;
    return metal ? radiance * recoloured(there.base_colour, light.material.base_colour) : radiance;
}

double LightSet::termination_probability(const CoveredHit& hit, double pdf) const {
    if (complete)
        return holds_light(hit.segment.point->material) ? 1.0 : 0.0;
    if (hit.shares.count == 0)
        return 0.0;
    if (!settings_.path_extension)
        return 1.0;     // kinds that no ray hits have been sampled for all that such surfaces reflect
    double area = 0.0;  // as of lights that do not fade: of two sets that overlap, each is as dense as one alone
    for (int i = 0; i < hit.shares.count; ++i) {
        const VirtualLight& light = lights[hit.shares.light[i]];
        area += hit.shares.weight[i] * light.area / light.share;
    }
    const RaySegment& segment = hit.segment;
    const double cosine = std::abs(glm::dot(segment.point->geometric_normal, segment.ray.direction));
    const double n = segment.end * segment.end / (pdf * cosine * area);
    if (!(n < settings_.n_max))  // pdf * cosine of 0 as well
        return 1.0;
    return std::clamp((n - settings_.n_min) / (settings_.n_max - settings_.n_min), 0.0, 1.0);
}

}  // namespace brisance
