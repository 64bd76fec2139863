// Light that surfaces send into the medium: the cell MS.
#pragma once

#include "medium_lighting/lit_lattice.h"
#include "statistics/statistics.h"

namespace brisance {

// Light at the nodes: of the virtual lights as points, and of particles for light that those do not hold. `share`:
// of the lattice in what is shown, as of gather_adaptively(). `first`: what has arrived before them, beside which the
// noise of particles counts.
Gathered light_from_surfaces(const LitLattice& lattice, const Gathered& first, float share, Statistics& statistics,
                             Progress& progress);

}  // namespace brisance
