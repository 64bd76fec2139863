#include "medium_lighting/automatic_levels.h"

#include "lighting_grid/lighting_grid.h"
#include "medium_lighting/levels/lighting_level.h"
#include "scattering/lattice_level.h"

namespace brisance {

AutomaticLevels automatic_levels_of(const Medium& medium, const Surroundings* surroundings,
                                    const LightingSettings& settings, const ScatteringSettings& scattering) {
    if (medium.lattice.brick_count() == 0)
        return {};
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const LightingLevels levels = lighting_levels(medium, settings, surroundings);
    return {levels.first.level, levels.smoke.level, automatic_levels(medium),
            lattice_of_series(pyramid, scattering, settings.error).level};
}

}  // namespace brisance
