// Light that smoke scatters on toward smoke, and so on: the source of MM and SM.
//
// The orders of scattering are solved on a coarse lattice; the last flight before the camera is gathered once more on
// the lattice itself, from the sum of all orders, or order by order where each is to have a layer of its own.
#pragma once

#include <memory>

#include "medium_lighting/exterior/exterior_lights.h"

namespace brisance {

struct SmokeLight {
    std::vector<Rgb> multiple;                 // source function of MM per node
    std::vector<std::vector<Rgb>> orders;      // of its parts, where orders are kept apart; the last is the tail
    std::unique_ptr<ExteriorLights> exterior;  // where LitLattice::lights_exterior(), or null
};

// `once`: light leaving the nodes after its first scattering, not sharpened.
// `share`: of the light on this lattice in what is shown.
SmokeLight light_from_smoke(const LitLattice& lattice, float share, const ScatteredLight& once, Statistics& statistics,
                            Progress& progress);

}  // namespace brisance
