// Light on a coarser lattice than the medium's: the medium there, and the light back at the medium's nodes.
#pragma once

#include <span>
#include <vector>

#include "medium/lattice/corners_seen.h"
#include "medium/medium.h"

namespace brisance {

// The medium on the lattice 2^level coarser: mean extinction, mean emission as an emission coefficient, and mean albedo
// by extinction, with the contrast of the fine medium. Means over coarse hats, interpolated by the same hats, are the
// field after a blur of (2 - 4^-level) h^2 / 6 per axis, h the coarse spacing. Through clumps without their contrast
// too little light escapes from between them. A conservative flux between neighbours undoes the blur, as for lights
// (lighting_grid/voxel_lights.h).
Medium medium_to_light(const Medium& fine, int level);

// Emission coefficient per node [W/(m^3 sr)], and its luminance.
std::vector<Rgb> emission_of(const Medium& medium);
std::vector<float> emission_luminance(const Medium& medium);

// Light at the nodes of a lattice from that at the nodes of one 2^level coarser, interpolated linearly, as the camera
// interpolates: the field is that of a medium whose own nodes are as far apart. `seen`: which of them count; null: all.
std::vector<Rgb> light_at_fine_nodes(const BrickLattice& coarse, const std::vector<Rgb>& light, int level,
                                     const BrickLattice& fine, const CornersSeen* seen = nullptr);
// The same for one value per node; and at those of one brick.
std::vector<float> scalars_at_fine_nodes(const BrickLattice& coarse, const std::vector<float>& values, int level,
                                         const BrickLattice& fine);
void scalars_at_fine_nodes(const BrickLattice& coarse, std::span<const float> values, int level,
                           const BrickLattice& fine, std::size_t brick, std::span<float, BrickLattice::kNodes> out);

}  // namespace brisance
