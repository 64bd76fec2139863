#include "medium_lighting/gather_lights.h"

namespace brisance {

Gathered gather_lights(const LitLattice& lattice, const HierarchyLights& lights, float alpha,
                       const GatherTarget& target, std::vector<LevelCost>& costs, Progress& progress) {
    const LightingSettings& settings = lattice.input().lighting;
    ShadowMapCache maps{{}, true};
    ShadowMapCache* const cache = target.sparse ? &maps : nullptr;
    if (target.level == 0)
        return gather_at_nodes(lights.field(target.pyramid, alpha, settings, cache), target.request, costs, progress);
    const Medium& medium = target.pyramid.medium();
    ScatteredLight coarse = restricted(lights.light, lattice.medium().lattice, target.level);
    coarse.sharpen(medium.lattice);
    const HierarchyLights h = build_hierarchy(medium, std::move(coarse), 0);
    return gather_at_nodes(h.field(target.pyramid, alpha, settings, cache), target.request, costs, progress);
}

}  // namespace brisance
