#include "medium_lighting/level_lights.h"

#include "scattering/bounce_balance.h"

namespace brisance {

Gathered LevelLights::gather(const GatherTarget& target) const {
    const LightingSettings& settings = lattice_.input().lighting;
    ShadowMapCache maps{{}, true};
    ShadowMapCache* const cache = target.sparse ? &maps : target.level == 0 ? kept_ : nullptr;
    const auto of = [&](const HierarchyLights& lights) {
        return gather_at_nodes(lights.field(target.pyramid, alpha_, settings, cache), target.request, costs_,
                               progress_);
    };
    if (target.level == 0 || lights_.of_lamps)
        return of(lights_);
    const Medium& medium = target.pyramid.medium();
    ScatteredLight coarse = restricted_to(target.level);
    coarse.sharpen(medium.lattice, target.level);
    return of(build_hierarchy(medium, std::move(coarse), 0));
}

void LevelLights::balance(const GatherTarget& target, Gathered& light) const {
    if (!lattice_.input().lighting.energy_balance)
        return;
    light.scale(energy_balance_factor(target.pyramid, restricted_to(target.level),
                                      fluence_at_nodes(light, *target.request.needed)));
}

ScatteredLight LevelLights::restricted_to(int level) const {
    return restricted(lights_.light, lattice_.medium().lattice, level);
}

}  // namespace brisance
