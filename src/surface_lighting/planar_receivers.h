// Light at many receivers on planes: floors, walls and whatever else is flat.
//
// Without occlusion by surfaces, the irradiance of a plane by the medium changes as slowly as its distance from the
// smoke. It is therefore gathered at the points of a lattice on the plane and interpolated, cell by cell: a cell whose
// corners do not predict the points between them is divided, as in irradiance caching (Ward, Rubinstein and Clear,
// SIGGRAPH 1988), but by what was measured. The lattice is fixed in space, so that it stays where it is when the camera
// moves. Receivers that share a cell with few others are gathered themselves.
#pragma once

#include <functional>
#include <vector>

#include "medium/medium.h"
#include "medium_lighting/exterior/surface_receiver.h"

namespace brisance {

using GatherReceivers = std::function<void(std::vector<SurfaceReceiver>&)>;

// Fills `fire` and `smoke` of all receivers. `gather` does so for those that it is given.
void light_planar_receivers(const Medium& medium, std::vector<SurfaceReceiver>& receivers,
                            const GatherReceivers& gather);

}  // namespace brisance
