// Light that was gathered at some nodes of a lattice and interpolated at the others, and its energy balance.
//
// Two demands disagree where light is interpolated. The camera sees smooth changes of the light from one coarse node to
// the next. Energy is conserved where as much light collides around a coarse node as in the coarse medium, which an
// interpolant does not know: light is dim where smoke is dense. So the light is kept as the camera sees it, beside a
// factor per node with which it conserves energy. Light that scatters on is taken with the factor.
#pragma once

#include <vector>

#include "medium_lighting/lit_lattice.h"
#include "receivers/receivers.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

struct AdaptiveLight {
    Gathered light;  // at the needed nodes, prepared for interpolation by the camera

    // Per node, both empty where all light was gathered at the nodes themselves.
    GatheredPart gathered;          // what the nodes gathered themselves
    std::vector<float> conserving;  // the factor with which the light conserves energy

    // Makes `light` the light that conserves energy, as far as it is still the gathered one: `kept`, in [0, 1] per
    // node; empty: everywhere.
    void conserve(const std::vector<float>& kept);
};

// Scales the light so that the medium's own `lights` conserve energy. The nodes that gathered themselves set the scale
// of all light: what rays say collides there over what was gathered. The rest of the balance is what interpolation has
// added, and goes into the conserving factors of interpolated light.
void balance_light(const LitLattice& lattice, const ScatteredLight& lights, AdaptiveLight& light,
                   BounceBalance& balance);

}  // namespace brisance
