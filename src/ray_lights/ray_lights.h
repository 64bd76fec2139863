// The virtual ray lights of a frame, and their light along a ray of the camera and at a point of a surface (Novak,
// Nowrouzezahrai, Dachsbacher, Jarosz, SIGGRAPH 2012): the cells MM and SM, unbiased; surfaces scatter it by their
// BSDFs without delta lobes.
//
// Radiance along a camera ray due to one light of power P; u on the ray and v on the light are at the distance w:
//   P * integral over u and v of  sigma_s(u) sigma_s(v) p(u) p(v) T(0, u) T(0, v) T(u, v) V(u, v) / w^2  [W/(m^2 sr)]
// T(0, v) is 1 for short lights, which end where their particle collided. The integral is estimated with one pair,
// drawn as pair_sampling.h describes.
//
// At a point of a surface, BSDF times cosine replaces sigma_s(u) p(u) T(0, u), and there is no integral over u; v is
// sampled by the inverse square times the light's phase function. The BSDF is only evaluated, so that narrow lobes are
// noisy for a radius of 0. A caller that can sample those lobes does better (surface_shader.h): along_ray() of a ray in
// a sampled direction, times the share of rays in the shared lobes (gloss_split.h), is all of SM except light that was
// scattered once.
//
// With a radius, lights are beams: phase functions, BSDF and the inverse square are blurred, a bias that vanishes with
// the radius (beam.h). Lights are selected by resample_lights.h.
#pragma once

#include <span>
#include <vector>

#include "light_selection/in_scattering.h"
#include "light_selection/medium_light_tree.h"
#include "ray_lights/beam.h"
#include "ray_lights/pair_sampling.h"
#include "ray_lights/trace_ray_lights.h"

namespace brisance {

// The settings of a pass, counted from 0: with its own seed, and a radius reduced from `first` [m], that of pass 0.
RayLightSettings settings_of_pass(RayLightSettings settings, int pass, double first);

class RayLights : public InScattering {
public:
    // Traces, thins out and sorts the lights. Keeps a reference to the scene. `receivers`: represent all that the
    // camera sees, for the roulette. `bounces` as in trace_ray_lights().
    RayLights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
              std::span<const LightReceiver> receivers);

    Rgb along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost = nullptr) const override;
    int gloss_samples() const override { return lights_.empty() ? 0 : settings_.samples; }
    Rgb at_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                   SelectionCost* cost = nullptr) const override;
    // Estimated with one pair per light.
    Rgb along_ray_from_all(const RayMedium& seen, Rng& rng) const override;
    Rgb at_surface_from_all(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer,
                            Rng& rng) const override;

    std::span<const RayLight> lights() const { return lights_; }
    const RayLightReport& report() const { return report_; }
    double radius() const { return lights_.empty() ? 0.0 : lights_.front().radius; }  // [m]
    std::uint64_t bytes() const { return lights_.size() * sizeof(RayLight) + tree_.bytes(); }

private:
    double target_along(const RayMedium& seen, const RayLight& light) const;
    double target_at(const dvec3& point, const dvec3& normal, const RayLight& light) const;
    Rgb pair(const RayMedium& seen, const RayLight& light, Rng& rng) const;
    Rgb to_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer,
                   const RayLight& light, Rng& rng) const;
    double reaches_along(const RayLight& light, double v, Rng& rng) const;
    bool occluded(const Ray& ray, double end) const;

    const DirectLight& scene_;
    RayLightSettings settings_;
    const PairSampling& sampling_;
    RayLightReport report_;
    std::vector<RayLight> lights_;
    MediumLightTree tree_;
};

}  // namespace brisance
