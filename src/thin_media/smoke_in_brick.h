// Where in a brick smoke lies, and whether surfaces part it.
#pragma once

#include <optional>

#include "medium/lattice/occluders.h"
#include "medium/medium.h"

namespace brisance {

// Nodes counted from the brick's first one, both ends included. The last ones are the first of the next brick.
struct BrickPart {
    ivec3 low{0}, high{BrickLattice::kSize};
    bool empty() const { return glm::any(glm::greaterThan(low, high)); }
};

// The box around the nodes of a brick that scatter or absorb light, or that box without its outermost nodes: what fills
// a room reaches beyond its walls by a part of a voxel. None if surfaces part the nodes of both.
std::optional<BrickPart> unparted_smoke(const Occluders& surfaces, const Medium& medium, std::size_t brick);

}  // namespace brisance
