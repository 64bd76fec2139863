// What point lights in the medium send along a ray of the camera, and to a place, with their bound.
//
// Sent along a camera ray by one light of power P, with the point u on the ray, w away from the light:
//   P * integral over u of  sigma_s(u) p(u) p(light) T(0, u) T(u, light) V(u, light) min(1 / w^2, b)     [W/(m^2 sr)]
// One u estimates it, drawn by one of two densities which share it by the balance heuristic: the inverse square with
// both phase functions, and a flight along the camera's ray.
#pragma once

#include <vector>

#include "light_selection/resample_lights.h"
#include "transport/direct_light.h"
#include "volumetric_vpls/bound.h"
#include "volumetric_vpls/volumetric_vpl.h"

namespace brisance {

class VplSum {
public:
    // Keeps a reference to the scene. `bounces`: the most scatterings of a path; -1: all.
    VplSum(const DirectLight& scene, std::vector<VolumetricVpl> lights, const Bound& bound, int bounces);

    // By so many of the lights [W/(m^2 sr)].
    Rgb along_ray(const RayMedium& seen, int samples, Rng& rng, SelectionCost* cost = nullptr) const;
    // What a place that is the scattering number `order` of a path from the camera sends back on that path, by so many
    // of the lights; of surfaces without their delta lobes [W/(m^2 sr)].
    Rgb at(const PathVertex& place, int order, int samples, Rng& rng, SelectionCost* cost = nullptr) const;

    // The same from every light.
    Rgb along_ray_from_all(const RayMedium& seen, Rng& rng) const;
    Rgb at_from_all(const PathVertex& place, int order, Rng& rng) const;

    std::span<const VolumetricVpl> lights() const { return lights_; }
    const Bound& bound() const { return bound_; }
    std::uint64_t bytes() const { return lights_.size() * sizeof(VolumetricVpl) + tree_.bytes(); }

private:
    double wanted_along(const RayMedium& seen, const LightReceiver& receiver, const VolumetricVpl& light) const;
    double wanted_at(const PathVertex& place, int order, const VolumetricVpl& light) const;
    Rgb to_ray(const RayMedium& seen, const VolumetricVpl& light, Rng& rng) const;
    Rgb to_place(const PathVertex& place, int order, const VolumetricVpl& light, Rng& rng) const;
    LightReceiver receiver_at(const PathVertex& place) const;
    bool within_bounces(int order, const VolumetricVpl& light) const;
    bool occluded(const Ray& ray, double end) const;

    const DirectLight& scene_;
    std::vector<VolumetricVpl> lights_;
    MediumLightTree tree_;
    Bound bound_;
    int bounces_;
    double short_way_;  // [m]
};

}  // namespace brisance
