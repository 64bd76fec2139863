// Which nodes of a coarse lattice the nodes of a finer one see past surfaces.
//
// What is known on a coarse lattice is interpolated between the eight nodes around a point. Beside a floor or a wall
// some of them lie behind it, in the dark or in the light of another room.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "medium/lattice/occluders.h"
#include "medium/medium.h"

namespace brisance {

class CornersSeen {
public:
    using OfBrick = std::array<std::uint8_t, BrickLattice::kNodes>;
    static constexpr std::uint8_t kAll = 0xff;

    // From the nodes of `fine` to those of the lattice 2^level coarser around each.
    CornersSeen(const Medium& fine, int level, const Occluders& occluders);
    // From the nodes of a lattice that is 2^coarsening coarser than the medium's own. `needed`: per node, those that
    // are asked for.
    CornersSeen(const Medium& medium, const BrickLattice& lattice, int coarsening,
                const std::vector<std::uint8_t>& needed, int level, const Occluders& occluders);

    // Per node of a brick of the finer lattice: bit 4 x + 2 y + z is set where the corner at that side of the coarse
    // cell is seen or has no weight. Null: all are, of all nodes.
    const OfBrick* of_brick(std::size_t brick) const { return bricks_[brick].get(); }

private:
    class FineNodes;
    void find(const FineNodes& fine, int level, const Occluders& occluders);

    std::vector<std::unique_ptr<OfBrick>> bricks_;
};

// The part of the smoke that a coarser lattice puts behind surfaces, where it spreads each node's share to the corners
// around it: of the extinction, in [0, 1]. From some nodes of each brick, the same ones in any frame.
double part_beyond_surfaces(const Medium& fine, int level, const Occluders& occluders);

}  // namespace brisance
