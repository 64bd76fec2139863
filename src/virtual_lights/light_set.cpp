#include "virtual_lights/light_set.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

// Of a light's radiance in one direction, with which all paths end on it: its relative variance is an eighth then.
constexpr double kPhotonsBehind = 8.0;

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

LightSet::Ending LightSet::ending(const CoveredHit& hit, double pdf) const {
    if (complete)
        return holds_light(hit.segment.point->material) ? Ending{1.0, 1.0} : Ending{};
    if (hit.shares.count == 0)
        return {};
    if (!settings_.path_extension)
        return {1.0, 1.0};  // kinds that no ray hits have been sampled for all that such surfaces reflect
    Ending out;
    for (int i = 0; i < hit.shares.count; ++i) {
        const VirtualLight& light = lights[hit.shares.light[i]];
        const Ending part = held(light, -glm::dot(light.frame.normal, hit.segment.ray.direction));
        out.path += hit.shares.weight[i] * part.path;
        out.light += hit.shares.weight[i] * part.light;
    }
    const double share = out.path > 0.0 ? share_by_footprint(hit, pdf) : 0.0;
    return {out.path * share, out.light * share};
}

double LightSet::share_by_footprint(const CoveredHit& hit, double pdf) const {
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

// A narrow lobe shows few of the photons that have arrived, and one photon in it is a bright grain: then the path finds
// what is reflected.
LightSet::Ending LightSet::held(const VirtualLight& light, double cosine) const {
    if (light.profile < 0 || !settings_.path_extension)
        return {1.0, 1.0};
    const Profiles::Behind behind = profiles.photons_behind(light, cosine);
    return {std::min(1.0, behind.photons / kPhotonsBehind),
            std::clamp((behind.photons - behind.one) / kPhotonsBehind, 0.0, 1.0)};
}

double LightSet::mean_held(const VirtualLight& light) const {
    double sum = 0.0;
    for (int i = 0; i < Profiles::kCosines; ++i)
        sum += held(light, (i + 0.5) / Profiles::kCosines).path;
    return sum / Profiles::kCosines;
}

}  // namespace brisance
