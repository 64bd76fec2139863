// The smoke just around nodes.
#pragma once

#include <vector>

#include "core/vec.h"
#include "medium/lattice/brick_lattice.h"

namespace brisance {

// Per node: the mean over directions of the optical depth from the node to `reach` [m] away, at most two nodes along
// each axis. `local_from_index` spans the lattice [m per node].
std::vector<float> near_depths(const BrickLattice& lattice, const std::vector<float>& extinction,
                               const mat3& local_from_index, float reach);

}  // namespace brisance
