// Marks where a medium is thin or empty for a brick around, so that rays need only few samples there.
#pragma once

#include <cstdint>
#include <vector>

#include "medium/lattice/brick_lattice.h"

namespace brisance {

class HomogeneousBricks {
public:
    HomogeneousBricks() = default;  // nowhere
    // `thin`: per brick of the lattice; positions will be in nodes relative to the reference node.
    HomogeneousBricks(const BrickLattice& lattice, const ivec3& reference_node, const std::vector<std::uint8_t>& thin);

    bool empty() const { return even_.empty(); }
    bool at(const ivec3& brick) const;  // relative to the reference node's

    // The data that a kernel needs: a flag per brick of a box, with a rim that represents everything outside.
    struct View {
        const std::int32_t* even;
        std::int32_t min_brick[3];
        std::int32_t extent[3];
    };
    View view() const;

private:
    std::vector<std::int32_t> even_;
    ivec3 min_brick_{0}, extent_{0};
};

}  // namespace brisance
