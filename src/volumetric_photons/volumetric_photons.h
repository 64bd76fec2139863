// Light scattered by the medium, estimated by photons: along their tracks through the medium, for the camera and for
// rays that leave surfaces (track_length_cache.h), and where they land on surfaces (photon_map.h). The cells MM and SM
// without noise that varies between camera rays. The estimates are blurred over a voxel in the medium and over a disc
// of `neighbours` photons on surfaces.
#pragma once

#include "light_selection/in_scattering.h"
#include "transport/particle_walk.h"
#include "volumetric_photons/photon_map.h"
#include "volumetric_photons/settings.h"
#include "volumetric_photons/track_length_cache.h"

namespace brisance {

struct VolumetricPhotonReport : FlightReport {
    std::uint64_t surface_photons = 0;
};

class VolumetricPhotons : public InScattering {
public:
    // Traces the particles. Keeps a reference to the scene. `bounces`: the most scatterings, -1: no limit; `eye`: local
    // [m]; `other_rays`: along_ray() will be called for rays that do not start at the eye.
    VolumetricPhotons(const DirectLight& scene, const VolumetricPhotonSettings& settings, int bounces, const dvec3& eye,
                      bool other_rays);

    Rgb along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost = nullptr) const override;
    Rgb at_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                   SelectionCost* cost = nullptr) const override;

    const VolumetricPhotonReport& report() const { return report_; }
    std::uint64_t bytes() const { return cache_.bytes() + photon_map_.bytes(); }

private:
    std::vector<SurfacePhoton> follow(int most_before);
    bool from_eye(const Segment& ray) const;

    const DirectLight& scene_;
    VolumetricPhotonSettings settings_;
    dvec3 eye_;
    VolumetricPhotonReport report_;
    TrackLengthCache cache_;
    PhotonMap photon_map_;
};

}  // namespace brisance
