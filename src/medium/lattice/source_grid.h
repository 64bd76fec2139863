// A file's grid as a field on the medium's lattice.
#pragma once

#include <optional>
#include <vector>

#include "medium/lattice/brick_lattice.h"
#include "volume/vdb_file.h"

namespace brisance {

// A BlockGrid seen as a field on a brick lattice: both store 8^3 nodes with z fastest, in the same order.
struct SourceGrid {
    const BlockGrid* grid;  // kept
    BrickLattice lattice;
    dmat4 index_from_target;     // this grid's index space from the medium's
    std::optional<ivec3> shift;  // set when the two lattices differ by whole nodes: this = target + shift
};

// The grid's transform, with samples at i + 1/2 where `half_voxel_shift` says so.
dmat4 shifted(const BlockGrid& grid, bool half_voxel_shift);

SourceGrid source_grid(const BlockGrid& grid, bool half_voxel_shift, const dmat4& world_from_target);

// At a node of the target: the grid's own value where lattices agree, trilinear elsewhere; 0 outside all blocks.
float read(const SourceGrid& s, const ivec3& target_node, int channel);

// Target bricks that the non-zero nodes of `s` can reach by interpolation: a block's corners, one node wider, mapped.
// Throws Error Temporary before memory is taken when the target is so much finer that they would not fit.
void add_bricks(const SourceGrid& s, std::vector<ivec3>& bricks);

}  // namespace brisance
