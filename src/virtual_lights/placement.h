// From many candidates to the places of few virtual lights.
#pragma once

#include "virtual_lights/camera_candidates.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

// At most settings.count lights, which know their place and radius but hold no light yet. Candidates without another
// one elsewhere become no light.
std::vector<VirtualLight> place_lights(const Scene& scene, const std::vector<LightCandidate>& candidates,
                                       const VirtualLightSettings& settings);

// A light that knows its place but not its radius.
VirtualLight light_at(const Scene& scene, const LightCandidate& place);

}  // namespace brisance
