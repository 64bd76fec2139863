// Where in a brick smoke lies, and whether surfaces part it.
#pragma once

#include <optional>

#include "medium/lattice/occluders.h"
#include "medium/medium.h"

namespace brisance {

// Nodes counted from the brick's first one, both ends included. The last ones are the first of the next brick.
struct BrickPart {
    ivec3 low{0}, high{BrickLattice::kSize};
    bool contains(const ivec3& node) const {
        return glm::all(glm::greaterThanEqual(node, low)) && glm::all(glm::lessThanEqual(node, high));
    }
    bool empty() const { return glm::any(glm::greaterThan(low, high)); }
};

// The box around the nodes of a brick that scatter or absorb light, or that box without its outermost nodes, which may
// lie beyond a wall: what fills a room reaches beyond it by a part of a voxel. None if surfaces part the nodes of both.
std::optional<BrickPart> unparted_smoke(const Occluders& surfaces, const Medium& medium, std::size_t brick);

}  // namespace brisance
