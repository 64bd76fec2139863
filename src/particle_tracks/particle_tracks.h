// Light that the medium scattered, by particles: along their ways through the medium, for the camera and for rays that
// leave surfaces (laid_light.h), and where they land on surfaces (landings.h). The cells MM and SM without any noise
// that changes from one camera ray to the next; what they blur is a voxel, and on surfaces a disc of `neighbours`
// landings.
#pragma once

#include "particle_tracks/laid_light.h"
#include "particle_tracks/landings.h"
#include "particle_tracks/settings.h"
#include "ray_lights/lights_in_smoke.h"
#include "tracing/particle_flights.h"

namespace brisance {

struct ParticleTrackReport : FlightReport {
    std::uint64_t landings = 0;
};

class ParticleTracks : public LightsInSmoke {
public:
    // Follows the particles. Keeps a reference to the scene. `bounces`: scatterings to follow, -1: all; `eye`: local
    // [m]; `other_rays`: along_ray() is asked for rays that do not come from the eye.
    ParticleTracks(const DirectLight& scene, const ParticleTrackSettings& settings, int bounces, const dvec3& eye,
                   bool other_rays);

    Rgb along_ray(const SeenMedium& seen, Rng& rng, RayLightCost* cost = nullptr) const override;
    Rgb at_surface(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                   RayLightCost* cost = nullptr) const override;

    const ParticleTrackReport& report() const { return report_; }
    std::uint64_t bytes() const { return laid_.bytes() + landings_.bytes(); }

private:
    std::vector<Landing> follow(int most_before);
    bool from_eye(const Segment& ray) const;

    const DirectLight& scene_;
    ParticleTrackSettings settings_;
    dvec3 eye_;
    ParticleTrackReport report_;
    LaidLight laid_;
    Landings landings_;
};

}  // namespace brisance
