// Light of surfaces, fire and emitters on a surface or in smoke, chosen from all of them together, so that samples go
// to whatever lights the point: "unified illumination" (B. Walter et al., Lightcuts, SIGGRAPH 2005).
//
// Every sampled light is of one kind and adds to that kind's cell of the ledger: SS, SV or SA on a surface, MS, MV or
// MA in smoke. Rays by BSDF or phase function find emitters too, and are weighted as without this (EmitterLights). The
// fire's lights shine on the Lambert base of surfaces alone: glossy lobes find the fire by rays through it.
#pragma once

#include "unified_lights/samplings.h"

namespace brisance {

// A point of a surface that many lights shine on.
struct UnifiedReceiver {
    const PathVertex& vertex;  // all lobes
    const PathVertex* base;    // the Lambert base, which alone is lit by the fire's lights; null: there is none
};

class UnifiedLights {
public:
    // As LightsOfAllKinds.
    UnifiedLights(const DirectLight& scene, const DirectLight& through, const VirtualLights* virtual_lights,
                  double point_bound, const CellSet& wanted, const UnifiedLightSampling& sampling,
                  const UnifiedLightSettings& settings);
    UnifiedLights(const UnifiedLights&) = delete;
    UnifiedLights& operator=(const UnifiedLights&) = delete;

    // For the surface that a ray of a pixel of the camera meets. Pictures of different seeds share no random numbers.
    Rng rng(std::uint32_t pixel, std::uint64_t number) const;
    // One estimate of what the receiver scatters of the lights. Rays by BSDF, and light that virtual lights do not
    // hold, are the caller's.
    LightBySender at(const UnifiedReceiver& receiver, Rng& rng) const;

    // The same of the smoke on a ray of the camera.
    Rng ray_rng(std::uint32_t pixel, std::uint64_t number) const;
    // One estimate of MS, MV and MA along the ray: of the lights, and of what rays by phase function find of emitters
    // and of what virtual lights do not hold. `seen`: the medium on `ray`.
    LightBySender along(const RayMedium& seen, const Ray& ray, Rng& rng) const;

    const LightsOfAllKinds& lights() const { return lights_; }
    std::uint64_t bytes() const { return lights_.bytes() + gatherer_->bytes(); }

private:
    LightBySender by_phase(const PathVertex& vertex, Rng& rng) const;

    const DirectLight& scene_;
    const VirtualLights* virtual_lights_;
    LightsOfAllKinds lights_;
    std::unique_ptr<UnifiedGatherer> gatherer_;
    int points_;
    std::uint32_t seed_;
};

}  // namespace brisance
