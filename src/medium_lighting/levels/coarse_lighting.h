// Light on a coarser lattice than the medium's: the medium there, and the light back at the medium's nodes.
#pragma once

#include <vector>

#include "medium/medium.h"

namespace brisance {

// The medium on the lattice 2^level coarser: mean extinction, mean emission as an emission coefficient, and mean albedo
// by extinction.
Medium medium_to_light(const Medium& fine, int level);

// The same for light of the smoke, with the contrast of the fine extinction. Means over coarse hats, interpolated by
// the same hats, are the extinction after a blur of (2 - 4^-level) h^2 / 6 per axis, h the coarse spacing. Through
// clumps without their contrast too little light escapes from between them. A conservative flux between neighbours
// undoes the blur, as for lights (lighting_grid/voxel_lights.h).
Medium medium_to_light_smoke(const Medium& fine, int level);

// Luminance of the emission coefficient per node [W/(m^3 sr)].
std::vector<float> emission_luminance(const Medium& medium);

// How light is interpolated between coarse nodes.
enum class Interpolation {
    EighthRoots,  // where light falls almost exponentially from node to node
    Linear        // as the camera interpolates: the field is that of a medium whose own nodes are as far apart
};

// Light at the nodes of a lattice from that at the nodes of one 2^level coarser.
std::vector<Rgb> light_at_fine_nodes(const BrickLattice& coarse, std::vector<Rgb> light, int level,
                                     const BrickLattice& fine, Interpolation how);

}  // namespace brisance
