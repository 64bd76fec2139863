// Velocity within and around a medium.
#pragma once

#include <vector>

#include "medium/medium.h"

namespace brisance {

// On a lattice that holds all that moves: the medium's own bricks and those around them.
struct VelocityAround {
    BrickLattice lattice;
    std::vector<vec3> at_nodes;  // [nodes per frame]
};

// The velocity of the medium where there is some of it, continued outward by means of neighbouring nodes up to `reach`
// nodes away: what moves into empty air has the velocity of what it comes from.
VelocityAround velocity_around(const Medium& medium, int reach);

}  // namespace brisance
