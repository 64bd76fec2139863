#include "gathering/separations.h"

#include <algorithm>

#include "lighting_grid/voxel_lights.h"
#include "near_field/first_level.h"

namespace brisance {

mat3 first_level_lattice(const LightField& field, const GridLevel& level) {
    return field.pyramid->medium().local_from_index * float(1 << (level.level - 1));
}

const std::vector<float>& SeparationExtinction::at(int lattice_level) {
    constexpr float kBlur =
        0.25f;  // of h^2: half from the means' weights, two thirds from the hat, less the finer hat's
    if (lattice_level == 0)
        return pyramid_.nodes(0);
    const auto [entry, is_new] = sharpened_.try_emplace(lattice_level, pyramid_.nodes(lattice_level));
    if (is_new)
        sharpen_nodes(pyramid_.lattice(lattice_level), entry->second, 1, 0.5f * kBlur);
    return entry->second;
}

bool gathers_by_separations(const LightField& field, const GridLevel& level, int coarsening) {
    const bool stands_at_nodes = field.bottom == 0 && field.intensity && level.lobe.empty() && level.ball.empty();
    const bool receivers_at_nodes = coarsening == level.level - 1 || coarsening == level.level;
    return field.settings.shadows == ShadowMethod::Maps && stands_at_nodes && receivers_at_nodes && level.level >= 1 &&
           level.level <= std::min(kHighestBySeparations, field.pyramid->level_count()) && level.size() > 0 &&
           &level != &field.grid->levels.back() &&
           FirstLevel::is_small(first_level_lattice(field, level), field.alpha * level.spacing);
}

}  // namespace brisance
