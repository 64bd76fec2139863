// Light of lamps, suns and environments at the nodes of a medium: the cell MA.
#pragma once

#include "emitters/surroundings.h"
#include "gathering/gather.h"

namespace brisance {

// Every node asks the same few places on the emitters, so that what noise is left in area lights and environments is
// smooth across the medium; point lights and suns are exact but for the march of half a voxel.
Gathered gather_from_emitters(const Surroundings& surroundings, const ExtinctionPyramid& pyramid,
                              const LatticeRequest& request);

}  // namespace brisance
