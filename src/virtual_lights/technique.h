// A technique of virtual lights: a placement, a flux, a kind and a gatherer, joined.
#pragma once

#include <memory>

#include "virtual_lights/gatherers/gatherer.h"
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
};

// Throws Error Usage for settings that check() refuses.
Technique technique_of(const VirtualLightSettings& settings);

}  // namespace brisance
