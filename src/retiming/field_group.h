// Fields of two frames that share one lattice.
#pragma once

#include "retiming/between_frames.h"
#include "retiming/common_lattice.h"

namespace brisance {

struct FieldPair {
    std::size_t role = 0;
    std::optional<BlockGrid> grid[2];  // of the first and the second frame; info and census, and values until loaded
    std::vector<float> values[2];      // at the nodes of the group's lattice
    int channels = 1;
};

struct FieldGroup {
    dmat4 world_from_index{1.0};
    BrickLattice lattice;  // the bricks of all its fields in both frames
    std::vector<FieldPair> fields;

    // Per node, whether any field of frame 0 or 1 has something there.
    std::vector<std::uint8_t> occupied(int frame) const;
};

// Those of equal transforms together. Roles without any grid are in no group.
std::vector<FieldGroup> group_fields(const SourceFrame& first, const SourceFrame& second);

}  // namespace brisance
