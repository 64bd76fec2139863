#include "medium_lighting/automatic_levels.h"

#include "lighting_grid/lighting_grid.h"
#include "medium_lighting/levels/lighting_level.h"

namespace brisance {

AutomaticLevels automatic_levels_of(const Medium& medium, const Surroundings* surroundings,
                                    const LightingSettings& settings) {
    if (medium.lattice.brick_count() == 0)
        return {};
    const LightingLevels levels = lighting_levels(medium, settings, surroundings);
    return {levels.first.level, levels.smoke.level, automatic_levels(medium)};
}

}  // namespace brisance
