// Marks per node of a lattice, brick by brick.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "medium/lattice/brick_lattice.h"

namespace brisance {

// Whether any node of the brick is marked.
inline bool any_in_brick(const std::vector<std::uint8_t>& mask, std::size_t brick) {
    const auto first = mask.begin() + std::ptrdiff_t(brick * BrickLattice::kNodes);
    return std::any_of(first, first + BrickLattice::kNodes, [](std::uint8_t m) { return m != 0; });
}

}  // namespace brisance
