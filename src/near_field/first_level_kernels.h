// The vector kernel of the first level: rows of eight receivers of one parity for all separations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "near_field/first_level.h"

namespace brisance {

// Separations of one parity whose cells and nodes are given as offsets in a block's box.
struct FlatSeparations {
    struct Tap {
        int offset;  // in the eight planes of extinction
        float length, change[3];
    };
    struct Separation {
        int offset;
        vec3 to_vertex;
        bool own;  // as of FirstLevel::Separation
        int first_tap, last_tap;
    };
    std::vector<Separation> separations;
    std::vector<Tap> taps;
};

// 8^3 cells and a margin all round, planar, z fastest.
struct FirstLevelBlock {
    static constexpr int kCells = BrickLattice::kNodes;

    std::size_t plane;
    const float* extinction;     // 8 planes, of the nodes of each parity
    const float* light;          // 6 planes: intensity, and shift from the vertex [m]
    const float* directional;    // 24 planes or null
    const float* toward_camera;  // 3 planes of kCells for this parity, or null
    float radius, mean_cosine;
    // Of this parity, planes of kCells; null: not asked for.
    float* fluence;
    float* scattered;
    float* moments;

    // Eight cells along z, by the index of the first one.
    struct Row {
        int in_box, in_block;
    };
    std::span<const Row> rows;
};

FlatSeparations flatten(const FirstLevel& level, int parity, int wide);
// Returns the number of light evaluations.
std::uint64_t gather_first_level(const FlatSeparations& separations, const FirstLevelBlock& block);

}  // namespace brisance
