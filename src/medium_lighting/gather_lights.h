// Light of the medium's own lights at the nodes of one of its lattices.
#pragma once

#include "medium_lighting/adaptive_gather.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

// `lights`: of the medium's own lattice, from which those of coarser ones are made.
Gathered gather_lights(const LitLattice& lattice, const HierarchyLights& lights, float alpha,
                       const GatherTarget& target, std::vector<LevelCost>& costs, Progress& progress);

}  // namespace brisance
