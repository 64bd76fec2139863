// The fire's own light at the medium's nodes: the source of MV, and of everything that scatters later.
#pragma once

#include <memory>

#include "medium_lighting/exterior/exterior_lights.h"

namespace brisance {

struct FireLight {
    Gathered arriving;                         // at the nodes; zero where single scattering is not needed
    std::vector<Rgb> single;                   // source function of MV per node; empty if not needed
    std::unique_ptr<ExteriorLights> exterior;  // where LitLattice::lights_exterior(), or null
};

// `share`: that of gather_adaptively().
FireLight light_from_fire(const LitLattice& lattice, float share, Statistics& statistics, Progress& progress);

}  // namespace brisance
