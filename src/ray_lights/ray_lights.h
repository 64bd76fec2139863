// Virtual ray lights of a frame, and what they send along a ray of the camera and to a point of a surface (Novak,
// Nowrouzezahrai, Dachsbacher, Jarosz, SIGGRAPH 2012): the cells MM and SM, unbiased, of surfaces what their BSDFs
// without delta lobes scatter.
//
// Sent along a camera ray by one light of power P, with points u on the ray and v on the light, w apart:
//   P * integral over u and v of  sigma_s(u) sigma_s(v) p(u) p(v) T(0, u) T(0, v) T(u, v) V(u, v) / w^2     [W/(m^2
//   sr)]
// T(0, v) is 1 for short lights, which end where their particle collided. One pair estimates it, drawn by one of two
// densities which share it by the balance heuristic: the inverse square with both phase functions, and a flight along
// the camera's ray with the same seen from where it collides.
// At a point of a surface BSDF times cosine stands in the place of sigma_s(u) p(u) T(0, u), and there is no integral
// over u; v is drawn by the inverse square with the light's phase function. The BSDF is only evaluated: narrow lobes
// are noisy without a radius. Whoever holds them does better (surface_shader.h): a ray in a direction that they draw
// sees the medium, and along_ray() of it, times the part that lobes which were given to be shared leave to rays
// (gloss_split.h), is all of SM but for light that was scattered once.
// With a radius, lights are beams: phase functions, BSDF and the inverse square are blurred, which is a bias that
// vanishes with the radius (beam.h).
// Which lights are asked: resample_lights.h.
#pragma once

#include <span>
#include <vector>

#include "light_selection/in_scattering.h"
#include "light_selection/medium_light_tree.h"
#include "ray_lights/beam.h"
#include "ray_lights/trace_ray_lights.h"

namespace brisance {

// Of a pass, from 0: with a seed of its own, and the radius that is left of `first` [m], that of pass 0.
RayLightSettings settings_of_pass(RayLightSettings settings, int pass, double first);

class RayLights : public InScattering {
public:
    // Traces, thins out and sorts the lights. Keeps a reference to the scene. `receivers`: what stands for all that the
    // camera sees, for the roulette. `bounces` as of trace_ray_lights().
    RayLights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
              std::span<const LightReceiver> receivers);

    Rgb along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost = nullptr) const override;
    int gloss_places() const override { return lights_.empty() ? 0 : settings_.samples; }
    Rgb at_surface(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                   SelectionCost* cost = nullptr) const override;
    // One pair each.
    Rgb along_ray_from_all(const RayMedium& seen, Rng& rng) const override;
    Rgb at_surface_from_all(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer,
                            Rng& rng) const override;

    std::span<const RayLight> lights() const { return lights_; }
    const RayLightReport& report() const { return report_; }
    double radius() const { return lights_.empty() ? 0.0 : lights_.front().radius; }  // [m]
    std::uint64_t bytes() const { return lights_.size() * sizeof(RayLight) + tree_.bytes(); }

private:
    double wanted_along(const RayMedium& seen, const RayLight& light) const;
    double wanted_at(const dvec3& point, const dvec3& normal, const RayLight& light) const;
    Rgb pair(const RayMedium& seen, const RayLight& light, Rng& rng) const;
    Rgb to_surface(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer,
                   const RayLight& light, Rng& rng) const;
    double reaches_along(const RayLight& light, double v, Rng& rng) const;
    bool occluded(const Ray& ray, double end) const;

    const DirectLight& scene_;
    RayLightSettings settings_;
    RayLightReport report_;
    std::vector<RayLight> lights_;
    MediumLightTree tree_;
};

}  // namespace brisance
