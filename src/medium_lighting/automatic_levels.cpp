#include "medium_lighting/automatic_levels.h"

#include "lighting_grid/lighting_grid.h"
#include "scattering/lattice_level.h"

namespace brisance {

AutomaticLevels automatic_levels_of(const Medium& medium) {
    if (medium.lattice.brick_count() == 0)
        return {};
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    return {automatic_levels(medium), automatic_lattice(pyramid).level};
}

}  // namespace brisance
