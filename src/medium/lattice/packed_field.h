// A field on a lattice's nodes, such as extinction, packed for fast trilinear sampling.
//
// Each packed brick of 8^3 voxels holds 9 x 9 x 8 words of 32 bits, word (x, y, z) being the half floats of nodes z and
// z + 1: a trilinear sample is four loads.
#pragma once

#include <cstdint>
#include <vector>

#include "medium/lattice/brick_lattice.h"

namespace brisance {

// The data that a kernel needs to sample one field. Positions are in the lattice's nodes, relative to the reference
// node.
struct PackedExtinction {
    static constexpr int kWordsPerBrick = 9 * 9 * 8;
    const std::int32_t* directory;  // first word of each brick; 0 for the empty brick; a rim of empty bricks all round
    const std::uint32_t* words;
    std::int32_t min_brick[3];
    std::int32_t extent[3];
    float scale;  // extinction [1/m], or another field's value, of a stored 1
};

class PackedField {
public:
    // `nodes`: values >= 0 at the lattice's nodes. The reference node's brick becomes brick 0.
    PackedField(const BrickLattice& lattice, const std::vector<float>& nodes, const ivec3& reference_node);

    PackedExtinction view() const;
    std::uint64_t bytes() const { return (directory_.size() + words_.size()) * 4; }

private:
    std::vector<std::int32_t> directory_;
    std::vector<std::uint32_t> words_;
    ivec3 min_brick_{0};
    ivec3 extent_{0};
    float scale_ = 0.0f;
};

}  // namespace brisance
