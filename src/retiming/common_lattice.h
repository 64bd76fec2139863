// Grids of two frames on one lattice, whatever their transforms.
#pragma once

#include <optional>

#include "medium/lattice/brick_lattice.h"
#include "volume/vdb_file.h"

namespace brisance {

constexpr std::size_t kNodesPerBrick = BrickLattice::kNodes;

// `grid` with the transform `world_from_index`: its own voxels where the lattices differ by whole voxels, as where a
// simulation's domain grows, else trilinear samples.
BlockGrid on_lattice(BlockGrid grid, const dmat4& world_from_index);

BrickLattice lattice_of(const BlockGrid& grid);

// Values of a grid, which must have blocks of the lattice only or more, at the lattice's nodes; 0 where it has none.
std::vector<float> values_on(const BrickLattice& lattice, const BlockGrid* grid, int channels);

// A grid of values at a lattice's nodes: bricks of zeros are left out. Takes name, type and census from the grids of
// both frames, at least one of which is there.
BlockGrid grid_of(const BrickLattice& lattice, const std::vector<float>& values, const BlockGrid* a,
                  const BlockGrid* b);

}  // namespace brisance
