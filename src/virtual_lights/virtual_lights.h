// Light that surfaces reflect toward surfaces and smoke, by virtual lights where the camera can see their work.
//
// [1] T. Li, W. Wang, D. Lin, C. Yuksel, Virtual Blue Noise Lighting, HPG 2022.
//
// A technique is three choices: a placement leaves deposits on surfaces (placement/), lights of a kind are built of
// them (kinds/) with flux that photons bring (flux/), and a path vertex samples the lights by a gatherer (gatherers/).
// The table of all choices is technique.cpp. The default is [1]: lights lie where camera paths meet surfaces a second
// time, thinned out to blue noise; photons are divided among the lights around each hit (flux/photon_splitting.h); a
// vertex samples one light or one ray. Light is interpolated over the surfaces themselves: what a ray meets there
// decides, so that nothing is seen through walls, and all gatherers have the same mean.
//
// Departs from [1]: lights cover surfaces by a partition of unity, in receiving and in giving, with the covered area of
// each measured, and only where they see it. Kernels of fixed area darken at edges, and surface that lies hidden under
// things or in walls, where no photon comes, would take its share of light (5 % of a room behind a door). Plain Lambert
// surfaces keep the light that arrives and take the colour of the point where it leaves: textures stay sharp. Where no
// light covers a surface, paths continue.
#pragma once

#include <memory>

#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/single_lights.h"
#include "virtual_lights/light_set.h"
#include "virtual_lights/lit_smoke.h"

namespace brisance {

class VirtualLights {
public:
    // Keeps a reference to the scene. Without surfaces, or where nothing shines, nothing is built and shade() is black.
    // Throws Error Usage for settings out of range and for choices that do not go together (choices.h).
    // `positions`: of other frames, shared (placed_lights.h); empty, or where the technique has none: placed here.
    VirtualLights(const DirectLight& scene, const PixelCamera& camera, const VirtualLightSettings& settings,
                  std::span<const SharedPositions> positions = {});

    // One sample of the radiance [W/(m^2 sr)] that a path vertex scatters of what surfaces reflect toward it: the
    // ledger's cell SS for a surface, MS for smoke (without its albedo). Light that emitters or the fire send straight
    // to the vertex is not part of it. Its mean is right up to the lights' own blur and noise; with path extension,
    // that is only found where many lights lie in a ray's footprint.
    // `panes`: vertices may see fire and smoke straight through panes, which are surfaces. Sampled: the caller has
    // already lit the vertex by what is seen through them.
    // `smoke`: what later surfaces of the path see of the smoke, but with the probability `walks`; a walk through the
    // smoke finds it then, and always without `smoke`.
    // `vertices`: is raised by the number of vertices of the path, this one among them. `distance`: becomes that of the
    // surface which the first ray of the path meets [m], or stays as it is.
    // `reservoir`: becomes what the vertex itself has chosen of the lights, where reservoirs() is not null; that light
    // is missing in the sum then.
    // `lights_apart`: the caller lights the vertex by each_light(); the lights' share is missing in the sum then.
    // `blur`: angle by which receivers lie apart that share the sum, seen from what they are lit by [rad]; 0: none
    // share. Later vertices of the path widen their lobes to it. `bound`: gets what the bound of point lights and its
    // compensation do to the sum; processor time is taken for it.
    enum class Panes { Followed, Sampled };
    struct Shading {
        Panes panes = Panes::Followed;
        const LitSmoke* smoke = nullptr;
        float walks = 0.0f;
        int* vertices = nullptr;
        double* distance = nullptr;
        LightReservoir* reservoir = nullptr;
        BoundTally* bound = nullptr;
        bool lights_apart = false;
        double blur = 0.0;
    };
    Rgb shade(const PathVertex& vertex, Rng& rng, const Shading& how) const;
    Rgb shade(const PathVertex& vertex, Rng& rng) const { return shade(vertex, rng, Shading{}); }

    // Null: the sampling does not resample, or there are no lights.
    const ReservoirLights* reservoirs() const { return set_->lights.empty() ? nullptr : gatherer_->reservoirs(); }

    // Whether paths find what the lights do not hold: then any path to the same light may stand for shade().
    bool extend_paths() const { return !set_->complete && set_->settings().path_extension; }

    const std::vector<VirtualLight>& lights() const { return set_->lights; }
    const FluxSpots& spots() const { return set_->spots; }
    // One by one, for those who choose among them together with other lights. May not outlive these.
    std::unique_ptr<const SingleLights> each_light() const { return single_(*set_); }
    // Radiance of a light of its own surface's colour [W/(m^2 sr)]. `toward`: unit, world.
    Rgb radiance(const VirtualLight& light, const dvec3& toward) const { return set_->radiance(light, toward); }
    // How many lights cover a point where a ray has met a surface, up to LightShares::kMost; 0: paths continue there.
    int count_covering(const SurfaceHit& hit, const SurfacePoint& point) const {
        return set_->shares_at(hit, point).count;
    }
    // Whether the Lambert base of a point that a ray has met is among what the lights reflect, by their base_flux.
    bool hold_base(const SurfaceHit& hit, const SurfacePoint& point) const;
    const Profiles& profiles() const { return set_->profiles; }
    const VirtualLightReport& report() const { return set_->report; }

private:
    class ExtendedPath;  // path_extension.cpp
    using Seen = CoveredHit;

    // What shade() reads along a path.
    bool samples_lights() const { return !set_->lights.empty() && gatherer_->samples_lights(); }
    BoundedLight from_lights(const PathVertex& vertex, Rng& rng) const { return gatherer_->from_lights(vertex, rng); }
    Seen seen_by(const RaySegment& segment) const { return set_->covered(segment); }
    LightSet::Ending ending(const Seen& seen, double pdf) const { return set_->ending(seen, pdf); }
    // Of the light at the segment's end, the share that virtual lights are not bounded to give less of.
    double share_kept(const PathVertex& vertex, const RaySegment& segment) const;
    Rgb at_end_of_ray(const PathVertex& vertex, const Seen& seen, double pdf) const {
        return gatherer_->from_ray(vertex, seen, pdf);
    }
    Rgb lamps_on(const RaySegment& segment, Rng& rng) const;

    const DirectLight& scene_;
    bool shines_ = false;
    std::unique_ptr<LightSet> set_;  // outlives the gatherer, which refers to it
    std::unique_ptr<const Gatherer> gatherer_;
    std::unique_ptr<SingleLights> (*single_)(const LightSet&);
};

}  // namespace brisance
