// What the lighting of a medium chooses from its voxels where the settings leave it open.
#pragma once

#include "emitters/surroundings.h"
#include "gathering/settings.h"
#include "medium/medium.h"

namespace brisance {

struct AutomaticLevels {
    int light = 0;     // lighting.lattice_level
    int smoke = 0;     // lighting.smoke_lattice_level
    int lighting = 1;  // lighting.levels
};

// `surroundings`: of the medium; null: none.
AutomaticLevels automatic_levels_of(const Medium& medium, const Surroundings* surroundings,
                                    const LightingSettings& settings);

}  // namespace brisance
