// What point lights in the medium send along a ray of the camera, and to a place, with their bound.
//
// Sent along a camera ray by one light of power P, with the point u on the ray, w away from the light:
//   P * integral over u of  sigma_s(u) p(u) p(light) T(0, u) T(u, light) V(u, light) min(1 / w^2, b)     [W/(m^2 sr)]
// One u estimates it, drawn by one of two densities which share it by the balance heuristic: the inverse square with
// both phase functions, and a flight along the camera's ray.
#pragma once

#include <vector>

#include "medium_points/bound.h"
#include "medium_points/medium_point.h"
#include "ray_lights/choose_lights.h"
#include "tracing/direct_light.h"

namespace brisance {

class PointSum {
public:
    // Keeps a reference to the scene. `bounces`: the most scatterings of a path; -1: all.
    PointSum(const DirectLight& scene, std::vector<MediumPoint> lights, const Bound& bound, int bounces);

    // By so many of the lights [W/(m^2 sr)].
    Rgb along_ray(const SeenMedium& seen, int samples, Rng& rng, RayLightCost* cost = nullptr) const;
    // What a place that is the scattering number `order` of a path from the camera sends back on that path, by so many
    // of the lights; of surfaces without their delta lobes [W/(m^2 sr)].
    Rgb at(const Scatterer& place, int order, int samples, Rng& rng, RayLightCost* cost = nullptr) const;

    // The same from every light.
    Rgb along_ray_from_all(const SeenMedium& seen, Rng& rng) const;
    Rgb at_from_all(const Scatterer& place, int order, Rng& rng) const;

    std::span<const MediumPoint> lights() const { return lights_; }
    const Bound& bound() const { return bound_; }
    std::uint64_t bytes() const { return lights_.size() * sizeof(MediumPoint) + tree_.bytes(); }

private:
    double wanted_along(const SeenMedium& seen, const RayLightReceiver& receiver, const MediumPoint& light) const;
    double wanted_at(const Scatterer& place, int order, const MediumPoint& light) const;
    Rgb to_ray(const SeenMedium& seen, const MediumPoint& light, Rng& rng) const;
    Rgb to_place(const Scatterer& place, int order, const MediumPoint& light, Rng& rng) const;
    RayLightReceiver receiver_at(const Scatterer& place) const;
    bool within_bounces(int order, const MediumPoint& light) const;
    bool occluded(const Ray& ray, double end) const;

    const DirectLight& scene_;
    std::vector<MediumPoint> lights_;
    RayLightTree tree_;
    Bound bound_;
    int bounces_;
    double short_way_;  // [m]
};

}  // namespace brisance
