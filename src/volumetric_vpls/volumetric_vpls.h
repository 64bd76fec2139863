// The volumetric virtual point lights of a frame, and their light along a ray of the camera and at a point of a
// surface: the cells MM and SM; surfaces scatter it by their BSDFs without delta lobes. Unbounded lights, and bounded
// ones with exact compensation, are unbiased. Unbounded lights have infinite variance, because of 1 / distance^2.
// Lights are selected by resample_lights.h.
#pragma once

#include <span>

#include "light_selection/in_scattering.h"
#include "volumetric_vpls/compensation.h"
#include "volumetric_vpls/trace_vpls.h"
#include "volumetric_vpls/vpl_sum.h"

namespace brisance {

class VolumetricVpls : public InScattering {
public:
    // Traces, thins out and sorts the lights. Keeps a reference to the scene. `receivers`: represent all that the
    // camera sees, for the roulette. `bounces` as in trace_vpls().
    VolumetricVpls(const DirectLight& scene, const VolumetricVplSettings& settings, int bounces,
                   std::span<const LightReceiver> receivers);
    VolumetricVpls(const VolumetricVpls&) = delete;
    VolumetricVpls& operator=(const VolumetricVpls&) = delete;

    Rgb along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost = nullptr) const override;
    Rgb at_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                   SelectionCost* cost = nullptr) const override;
    // With the same compensation.
    Rgb along_ray_from_all(const RayMedium& seen, Rng& rng) const override;
    Rgb at_surface_from_all(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer,
                            Rng& rng) const override;

    std::span<const VolumetricVpl> lights() const { return sum_.lights(); }
    const Bound& bound() const { return sum_.bound(); }
    const VolumetricVplReport& report() const { return report_; }
    std::uint64_t bytes() const { return sum_.bytes(); }

private:
    int samples_;
    VolumetricVplReport report_;
    VplSum sum_;
    Compensation compensation_;
};

}  // namespace brisance
