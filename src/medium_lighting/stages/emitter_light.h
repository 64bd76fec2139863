// Light of lamps, suns and environments at the nodes of a medium: the cell MA.
#pragma once

#include "emitters/surroundings.h"
#include "gathering/gather.h"

namespace brisance {

// Every node samples a few points on the emitters, different ones for each node. With the same points, all nodes would
// have the same error of about a tenth; independent noise is averaged along the camera rays. Point lights and suns
// without a disc take one ray each, and are exact except for the ray march, by half a voxel. Before a narrow sun smoke
// is the same for all of its disc, and takes one ray, too. A sample of an extended light stands for a cone of it, in
// which the smoke is averaged (optical_depths/cone_depths.h).
//
// Nodes that smoke hides from `eye` take fewer points. `seen`: the share of the nodes' light that the camera sees; the
// rest only scatters on.
Gathered gather_from_emitters(const Surroundings& surroundings, const ExtinctionPyramid& pyramid,
                              const LatticeRequest& request, const vec3& eye, float seen);

}  // namespace brisance
