// Light of lamps, suns and environments at the nodes of a medium: the cell MA.
#pragma once

#include "emitters/surroundings.h"
#include "gathering/gather.h"

namespace brisance {

// Every node asks a few places on the emitters, each node others: the few would be wrong by a tenth for all nodes
// alike, while independent noise is averaged along the camera's rays. Point lights and suns are exact but for the march
// of half a voxel.
Gathered gather_from_emitters(const Surroundings& surroundings, const ExtinctionPyramid& pyramid,
                              const LatticeRequest& request);

}  // namespace brisance
