// Light scattered by the medium, estimated by the density of photons: points or beams in the medium (photon_points.h,
// photon_beams.h), and a photon map on surfaces. The cells MM and SM, for the camera's rays and for those that leave
// surfaces alike. The estimates are biased by their blur: `passes` let its radius shrink
// (light_selection/progressive_radius.h; Jarosz, Nowrouzezahrai, Thomas, Sloan, Zwicker, Progressive Photon Beams,
// SIGGRAPH Asia 2011).
#pragma once

#include "light_selection/in_scattering.h"
#include "photon_density/photon_beams.h"
#include "photon_density/photon_points.h"

namespace brisance {

// Dimensions over which the estimator blurs.
int blurred_dimensions(DensityEstimator estimator);

// The settings of a pass, counted from 0: with its own seed, and a radius reduced from `first` [m], that of pass 0. The
// disc of photons on surfaces loses area in the same way.
PhotonDensitySettings settings_of_pass(PhotonDensitySettings settings, int pass, double first);

struct PhotonDensityReport : FlightReport {
    std::uint64_t stored = 0, surface_photons = 0;  // points or pieces of beams; photons on surfaces
    double radius = 0.0;                            // [m]
};

class PhotonDensity : public InScattering {
public:
    // Traces the photons. Keeps a reference to the scene. `bounces`: the most scatterings, -1: no limit;
    // `eye`: local [m], from which most rays come.
    PhotonDensity(const DirectLight& scene, const PhotonDensitySettings& settings, int bounces, const dvec3& eye);

    Rgb along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost = nullptr) const override;
    Rgb at_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                   SelectionCost* cost = nullptr) const override;

    double radius() const { return report_.radius; }  // [m]
    const PhotonDensityReport& report() const { return report_; }
    std::uint64_t bytes() const { return points_.bytes() + beams_.bytes() + photon_map_.bytes(); }

private:
    std::vector<SurfacePhoton> store(TracedPhotons photons, const dvec3& eye);

    const DirectLight& scene_;
    PhotonDensitySettings settings_;
    double longest_;  // piece of a beam, and the largest automatic radius [m]
    PhotonDensityReport report_;
    PhotonPoints points_;  // one of these two is empty
    PhotonBeams beams_;
    PhotonMap photon_map_;
};

}  // namespace brisance
