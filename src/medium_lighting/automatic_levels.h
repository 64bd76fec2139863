// What the lighting of a medium chooses from its voxels where the settings leave it open.
#pragma once

#include "emitters/surroundings.h"
#include "gathering/settings.h"
#include "medium/medium.h"
#include "scattering/settings.h"

namespace brisance {

struct AutomaticLevels {
    int light = 0;       // lighting.lattice_level
    int smoke = 0;       // lighting.smoke_lattice_level
    int lighting = 1;    // lighting.levels
    int scattering = 0;  // scattering.lattice_level
};

// `surroundings`: of the medium; null: none.
AutomaticLevels automatic_levels_of(const Medium& medium, const Surroundings* surroundings,
                                    const LightingSettings& settings, const ScatteringSettings& scattering);

}  // namespace brisance
