// Gathers light at the nodes of a medium at the resolution that the picture needs.
//
// Light is gathered on the coarsest lattice first (lit_levels.h), where a node costs as much as a voxel's but is one of
// 8^level. Its interpolation error is measured: nodes between even ones are compared with the interpolant through
// those, and the error of the next finer lattice is a quarter of it. Where this error, weighted by what the picture
// shows of the node, exceeds the share of the error allowed, light is gathered again at the nodes twice as fine, and so
// on down to the medium's own lattice. Nodes that are hidden, or smaller than a pixel, stay coarse. Refinement enters
// by a weight that fades from 0 to 1, so that a change of the camera or of the medium changes the field continuously.
//
// At each level the medium is that level's: mean extinction, with lights splatted to its nodes. Between nodes light is
// interpolated as its eighth root: in smoke it falls almost exponentially. Beside surfaces all nodes are lit.
#pragma once

#include "medium_lighting/adaptive_light.h"
#include "medium_lighting/level_lights.h"
#include "statistics/statistics.h"

namespace brisance {

// Light at the needed nodes of the lattice, as `request` says but for its nodes. `share`: of this light in what is
// shown; the rest lives on another lattice. A small part may err by as much more. Adds the number of nodes gathered at
// each level to `detail`.
AdaptiveLight gather_adaptively(const LitLattice& lattice, float share, const LatticeRequest& request,
                                const LevelLights& lights, nlohmann::ordered_json& detail);

}  // namespace brisance
