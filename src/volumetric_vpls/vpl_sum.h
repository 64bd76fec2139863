// Light of point lights in the medium along a ray of the camera and at a path vertex, with their bound.
//
// Radiance along a camera ray due to one light of power P; the point u on the ray is at the distance w from the light:
//   P * integral over u of  sigma_s(u) p(u) p(light) T(0, u) T(u, light) V(u, light) min(1 / w^2, b)     [W/(m^2 sr)]
// It is estimated with one u, sampled from one of two densities combined by the balance heuristic: the inverse square
// times both phase functions, and a free flight along the camera ray.
#pragma once

#include <vector>

#include "light_selection/resample_lights.h"
#include "transport/direct_light.h"
#include "volumetric_vpls/bound.h"
#include "volumetric_vpls/volumetric_vpl.h"

namespace brisance {

class VplSum {
public:
    // Keeps a reference to the scene. `bounces`: the most scatterings of a path; -1: no limit.
    VplSum(const DirectLight& scene, std::vector<VolumetricVpl> lights, const Bound& bound, int bounces);

    // Estimated from `samples` of the lights [W/(m^2 sr)].
    Rgb along_ray(const RayMedium& seen, int samples, Rng& rng, SelectionCost* cost = nullptr) const;
    // Light scattered back along the path at the vertex, the scattering number `order` of a path from the camera,
    // estimated from `samples` of the lights; without delta lobes of surfaces [W/(m^2 sr)].
    Rgb at(const PathVertex& vertex, int order, int samples, Rng& rng, SelectionCost* cost = nullptr) const;

    // The same, summed over every light.
    Rgb along_ray_from_all(const RayMedium& seen, Rng& rng) const;
    Rgb at_from_all(const PathVertex& vertex, int order, Rng& rng) const;

    std::span<const VolumetricVpl> lights() const { return lights_; }
    const Bound& bound() const { return bound_; }
    std::uint64_t bytes() const { return lights_.size() * sizeof(VolumetricVpl) + tree_.bytes(); }

private:
    double target_along(const RayMedium& seen, const LightReceiver& receiver, const VolumetricVpl& light) const;
    double target_at(const PathVertex& vertex, int order, const VolumetricVpl& light) const;
    Rgb to_ray(const RayMedium& seen, const VolumetricVpl& light, Rng& rng) const;
    Rgb to_vertex(const PathVertex& vertex, int order, const VolumetricVpl& light, Rng& rng) const;
    LightReceiver receiver_at(const PathVertex& vertex) const;
    bool within_bounces(int order, const VolumetricVpl& light) const;
    bool occluded(const Ray& ray, double end) const;

    const DirectLight& scene_;
    std::vector<VolumetricVpl> lights_;
    MediumLightTree tree_;
    Bound bound_;
    int bounces_;
    double short_length_;  // [m]
};

}  // namespace brisance
