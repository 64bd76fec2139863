// Techniques of the literature that virtual blue noise lighting is compared with.
#pragma once

#include "virtual_lights/choices.h"

namespace brisance {

// By name, help, and the settings that make them: those of instant radiosity, and what differs from it.
const std::vector<TechniquePreset>& baselines();

}  // namespace brisance
