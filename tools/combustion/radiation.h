// The share of its heat that each cell can radiate away: all of it at the boundary of the cloud, little of it deep
// inside or in a crease. This leaves a dark crust over a glowing interior.
#pragma once

#include "field.h"

namespace brisance::combustion {

// Mean over the 26 directions to a cell's neighbours of the transmittance exp(-absorption * integral of soot) from each
// cell to the outside, on a grid of half the resolution (all counts of `soot` even). The floor returns what it
// receives. `cell_size` is that of `soot` [m], `absorption` that of soot 1 [1/m].
Field<float> escape_fraction(const Field<float>& soot, float cell_size, float absorption);

}  // namespace brisance::combustion
