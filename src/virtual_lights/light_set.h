// The virtual lights of one frame and the surface they cover: what kinds of light and gatherers read.
#pragma once

#include <cstdint>
#include <vector>

#include "transport/direct_light.h"
#include "virtual_lights/flux/flux_spots.h"
#include "virtual_lights/flux/octahedral_profiles.h"
#include "virtual_lights/flux/partition_of_unity.h"
#include "virtual_lights/flux/photon_splitting.h"
#include "virtual_lights/settings.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

struct VirtualLightReport {
    std::uint64_t candidates = 0, lights = 0, profiles = 0;
    Rgb flux{0.0f};           // that all lights reflect [W]
    double acceptance = 1.0;  // PlacementReport
    PhotonReport photons;
    double candidate_seconds = 0.0, elimination_seconds = 0.0, area_seconds = 0.0, photon_seconds = 0.0,
           profile_seconds = 0.0, choice_seconds = 0.0;
    std::uint64_t bytes = 0;         // of what stays
    std::uint64_t photon_bytes = 0;  // needed besides while photons are traced
};

// A surface where a ray ends, and the lights that cover it.
struct CoveredHit {
    const RaySegment& segment;
    LightShares shares;
};

class LightSet {
public:
    // Keeps a reference to the scene.
    LightSet(const DirectLight& scene, const VirtualLightSettings& settings) : scene_(scene), settings_(settings) {}

    const DirectLight& scene() const { return scene_; }
    const VirtualLightSettings& settings() const { return settings_; }

    std::vector<VirtualLight> lights;
    PartitionOfUnity partition;  // of the covered surface among the lights; empty where they cover none
    Profiles profiles;
    FluxSpots spots;  // none where no smoke asks for them
    // Together the lights stand for all light that surfaces reflect, covered or not.
    bool complete = false;
    VirtualLightReport report;

    // The lights that cover a point of a surface; none where virtual lights cannot hold what it reflects.
    LightShares shares_at(const SurfaceHit& hit, const SurfacePoint& point) const;
    CoveredHit covered(const RaySegment& segment) const { return {segment, shares_at(*segment.hit, *segment.point)}; }

    // Radiance of a light of its own surface's colour [W/(m^2 sr)]. `toward`: unit, world.
    Rgb radiance(const VirtualLight& light, const dvec3& toward) const;
    // What one of the covering lights adds to the radiance that the ray finds [W/(m^2 sr)].
    Rgb reflected(const CoveredHit& hit, int share) const;
    // The fraction of a path that virtual lights end at this hit, the rest of it continues: by how many of them lie in
    // the footprint of a ray that was sampled with density `pdf` [1/sr], and by how many photons their light toward the
    // ray's origin comes from. And what their radiance is multiplied by, which has the same mean: a light's photons
    // decide of each of them as if that one had not come (Mecke's formula for Poisson processes), so that how many
    // there are and what they bring is not counted twice.
    struct Ending {
        double path = 0.0, light = 0.0;
    };
    Ending ending(const CoveredHit& hit, double pdf) const;
    // The mean over directions of what the photons of a light allow of that.
    double mean_held(const VirtualLight& light) const;

private:
    Ending held(const VirtualLight& light, double cosine) const;
    double share_by_footprint(const CoveredHit& hit, double pdf) const;

    const DirectLight& scene_;
    VirtualLightSettings settings_;
};

}  // namespace brisance
