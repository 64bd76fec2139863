// A technique of virtual lights: a placement, a flux, a kind and a gatherer, joined.
#pragma once

#include <memory>

#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/single_lights.h"
#include "virtual_lights/placement/placement.h"

namespace brisance {

struct Technique {
    const Placement* placement;
    // Places the lights and gives them flux.
    void (*build)(LightSet& set, const Placement& placement, const LightSources& sources);
    // Makes them lights of a kind.
    void (*fit)(LightSet& set);
    // Of a set that outlives it.
    std::unique_ptr<Gatherer> (*gather)(const LightSet& set, LightImportance importance);
    // The same lights one by one.
    std::unique_ptr<SingleLights> (*single)(const LightSet& set);
};

// Throws Error Usage for settings that check() refuses.
Technique technique_of(const VirtualLightSettings& settings);

}  // namespace brisance
