// Light of surfaces, fire and emitters on a surface, chosen from all of them together, so that samples go to whatever
// lights the point: "unified illumination" (B. Walter et al., Lightcuts, SIGGRAPH 2005).
//
// Every sampled light is of one kind and adds to that kind's cell of the ledger: SS, SV or SA. Rays by BSDF find
// emitters too, and are weighted as without this (EmitterLights). The fire's lights shine on the Lambert base alone:
// glossy lobes find the fire by rays through it.
#pragma once

#include "unified_lights/samplings.h"

namespace brisance {

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
    // One estimate of what the receiver scatters.
    LightBySender at(const UnifiedReceiver& receiver, Rng& rng) const;

    const LightsOfAllKinds& lights() const { return lights_; }
    std::uint64_t bytes() const { return lights_.bytes() + gatherer_->bytes(); }

private:
    LightsOfAllKinds lights_;
    std::unique_ptr<UnifiedGatherer> gatherer_;
    std::uint32_t seed_;
};

}  // namespace brisance
