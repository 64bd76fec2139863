// Light that the medium scattered, by particles: along their ways through the medium, for the camera and for rays that
// leave surfaces (track_length_cache.h), and where they land on surfaces (photon_map.h). The cells MM and SM without
// any noise that changes from one camera ray to the next; what they blur is a voxel, and on surfaces a disc of
// `neighbours` landings.
#pragma once

#include "light_selection/in_scattering.h"
#include "transport/particle_walk.h"
#include "volumetric_photons/photon_map.h"
#include "volumetric_photons/settings.h"
#include "volumetric_photons/track_length_cache.h"

namespace brisance {

struct VolumetricPhotonReport : FlightReport {
    std::uint64_t landings = 0;
};

class VolumetricPhotons : public InScattering {
public:
    // Follows the particles. Keeps a reference to the scene. `bounces`: scatterings to follow, -1: all; `eye`: local
    // [m]; `other_rays`: along_ray() is asked for rays that do not come from the eye.
    VolumetricPhotons(const DirectLight& scene, const VolumetricPhotonSettings& settings, int bounces, const dvec3& eye,
                      bool other_rays);

    Rgb along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost = nullptr) const override;
    Rgb at_surface(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                   SelectionCost* cost = nullptr) const override;

    const VolumetricPhotonReport& report() const { return report_; }
    std::uint64_t bytes() const { return laid_.bytes() + landings_.bytes(); }

private:
    std::vector<SurfacePhoton> follow(int most_before);
    bool from_eye(const Segment& ray) const;

    const DirectLight& scene_;
    VolumetricPhotonSettings settings_;
    dvec3 eye_;
    VolumetricPhotonReport report_;
    TrackLengthCache laid_;
    PhotonMap landings_;
};

}  // namespace brisance
