// Light that surfaces reflect toward surfaces and smoke, by virtual lights where the camera can see their work.
//
// [1] T. Li, W. Wang, D. Lin, C. Yuksel, Virtual Blue Noise Lighting, HPG 2022.
//
// Lights lie where camera paths meet surfaces a second time, thinned out to blue noise (placement.h); photons are
// shared out among the lights around each hit (photon_splitting.h); a place that asks draws one light or one ray
// (shading.cpp). It is an interpolation of light over the surfaces themselves: what a ray meets there decides, so that
// nothing is seen through walls, and all ways of sampling have the same mean.
//
// Departs from [1]: lights share what they speak for by weights that sum up to 1, in receiving and in giving, with the
// area of each measured, and only where they see it: kernels of fixed area darken at edges, and surface that lies
// hidden under things or in walls, where no photon comes, would take its share of light (5 % of a room behind a door).
// Plain Lambert surfaces keep the light that arrives and take the colour of the place where it leaves: textures stay
// sharp. Where no light speaks for a place, paths go on.
#pragma once

#include "transport/direct_light.h"
#include "virtual_lights/camera_candidates.h"
#include "virtual_lights/light_sampler.h"
#include "virtual_lights/octahedral_profiles.h"
#include "virtual_lights/partition_of_unity.h"
#include "virtual_lights/photon_splitting.h"

namespace brisance {

struct VirtualLightReport {
    std::uint64_t candidates = 0, lights = 0, profiles = 0;
    Rgb flux{0.0f};  // that all lights reflect [W]
    PhotonReport photons;
    double candidate_seconds = 0.0, elimination_seconds = 0.0, area_seconds = 0.0, photon_seconds = 0.0,
           profile_seconds = 0.0, choice_seconds = 0.0;
    std::uint64_t bytes = 0;         // of what stays
    std::uint64_t photon_bytes = 0;  // needed besides while photons are traced
};

class VirtualLights {
public:
    // Keeps a reference to the scene. Without surfaces, or where nothing shines, nothing is built and shade() is black.
    // Throws Error Usage for settings out of range.
    VirtualLights(const DirectLight& scene, const PixelCamera& camera, const VirtualLightSettings& settings);

    // One sample of the radiance [W/(m^2 sr)] that a place scatters of what surfaces reflect toward it: the ledger's
    // cell SS for a surface, MS for smoke (without its albedo). Light that emitters or the fire send straight to the
    // place is not part of it. Its mean is right up to the lights' own blur and noise; with extension, that is only
    // found where many lights lie in a ray's footprint. `vertices`: is raised by the number of places that the path
    // had, the asking one among them. `panes`: who may see fire and smoke straight through panes, which are surfaces:
    // if Asked, the place has been lit by that already.
    enum class Panes { Followed, Asked };
    Rgb shade(const PathVertex& place, Rng& rng, int* vertices = nullptr, Panes panes = Panes::Followed) const;

    const std::vector<VirtualLight>& lights() const { return lights_; }
    // What a light of its own surface's colour sends that way [W/(m^2 sr)]. `toward`: unit, world.
    Rgb radiance(const VirtualLight& light, const dvec3& toward) const;
    // How many lights speak for a place where a ray has met a surface, up to LightShares::kMost; 0: paths go on there.
    int speaking_for(const SurfaceHit& hit, const SurfacePoint& point) const { return shares_at(hit, point).count; }
    // Whether the Lambert base of a place that a ray has met is among what the lights reflect, by their base_flux.
    bool hold_base(const SurfaceHit& hit, const SurfacePoint& point) const;
    const Profiles& profiles() const { return profiles_; }
    const VirtualLightReport& report() const { return report_; }

private:
    class ExtendedPath;  // path_extension.cpp
    // A surface at the end of a ray, and the lights that speak for it.
    struct Seen {
        const RaySegment& segment;
        LightShares shares;
    };
    std::vector<LightCandidate> candidates(const PixelCamera& camera) const;
    void build(const PixelCamera& camera);
    void build_of_photons();
    void build_of_places(const PixelCamera& camera);
    void measure_lights();
    void finish_lights(const LightAccounts& accounts);
    LightShares shares_at(const SurfaceHit& hit, const SurfacePoint& point) const;
    Seen seen_by(const RaySegment& segment) const;
    Rgb reflected(const Seen& seen, int share) const;
    double termination_probability(const Seen& seen, double pdf) const;
    Rgb at_end_of_ray(const PathVertex& place, const Seen& seen, double pdf) const;
    Rgb lamps_on(const RaySegment& segment, Rng& rng) const;

    // asking.cpp
    struct Candidate;
    struct Clearance;
    bool asks_lights() const { return !lights_.empty() && settings_.sampling != LightSampling::Bsdf; }
    Rgb from_lights(const PathVertex& place, Rng& rng) const;
    Rgb from_light(const PathVertex& place, const LightTree::Choice& choice, Rng& rng) const;
    Rgb from_resampled(const PathVertex& place, Rng& rng) const;
    Candidate candidate(const PathVertex& place, Rng& rng) const;
    Rgb from_patch(const PathVertex& place, const LightTree::Choice& choice, Rng& rng) const;
    Rgb from_sphere(const PathVertex& place, const LightTree::Choice& choice, Rng& rng) const;
    Rgb from_point(const PathVertex& place, const LightTree::Choice& choice, Rng& rng) const;
    Rgb along_to_patch(const PathVertex& place, std::size_t light, const dvec3& direction,
                       const PathVertex::Value& scattered, Rng& rng) const;
    Rgb sent(const VirtualLight& light, const dvec3& toward) const;
    Rgb sent_by_point(const VirtualLight& light, const PathVertex& place, const dvec3& direction) const;
    Clearance clearance(const PathVertex& place, const VirtualLight& light) const;

    const DirectLight& scene_;
    VirtualLightSettings settings_;
    bool shines_ = false;
    std::vector<VirtualLight> lights_;
    PartitionOfUnity cover_;
    Profiles profiles_;
    LightChoice choice_;
    VirtualLightReport report_;
};

}  // namespace brisance
