// Volumetric virtual point lights of a frame, and what they send along a ray of the camera and to a point of a surface:
// the cells MM and SM, of surfaces what their BSDFs without delta lobes scatter. Unbounded, or bounded with exact
// compensation, they are unbiased; unbounded their variance is infinite, as 1 / distance^2 is.
// Which lights are asked: choose_lights.h.
#pragma once

#include <span>

#include "medium_points/compensation.h"
#include "medium_points/point_sum.h"
#include "medium_points/trace_medium_points.h"
#include "ray_lights/lights_in_smoke.h"

namespace brisance {

class MediumPoints : public LightsInSmoke {
public:
    // Traces, thins out and sorts the lights. Keeps a reference to the scene. `receivers`: what stands for all that the
    // camera sees, for the roulette. `bounces` as of trace_medium_points().
    MediumPoints(const DirectLight& scene, const PointLightSettings& settings, int bounces,
                 std::span<const RayLightReceiver> receivers);
    MediumPoints(const MediumPoints&) = delete;
    MediumPoints& operator=(const MediumPoints&) = delete;

    Rgb along_ray(const SeenMedium& seen, Rng& rng, RayLightCost* cost = nullptr) const override;
    Rgb at_surface(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                   RayLightCost* cost = nullptr) const override;
    // With the same compensation.
    Rgb along_ray_from_all(const SeenMedium& seen, Rng& rng) const override;
    Rgb at_surface_from_all(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer,
                            Rng& rng) const override;

    std::span<const MediumPoint> lights() const { return sum_.lights(); }
    const Bound& bound() const { return sum_.bound(); }
    const MediumPointReport& report() const { return report_; }
    std::uint64_t bytes() const { return sum_.bytes(); }

private:
    int samples_;
    MediumPointReport report_;
    PointSum sum_;
    Compensation compensation_;
};

}  // namespace brisance
