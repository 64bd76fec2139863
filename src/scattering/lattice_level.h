// The lattice that orders of scattering above one are solved on, chosen by the number of voxels.
#pragma once

#include "medium/lattice/extinction_pyramid.h"

namespace brisance {

// What scattering.lattice_level=auto means for this medium alone: the finest level with at most 120,000 nodes that
// scatter (more where most of them are haze).
int automatic_lattice_level(const ExtinctionPyramid& pyramid);

}  // namespace brisance
