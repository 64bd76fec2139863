// The lattice that orders of scattering above one are solved on, chosen by the volume that the smoke fills.
#pragma once

#include <span>

#include "medium/lattice/extinction_pyramid.h"
#include "scattering/settings.h"

namespace brisance {

// A level of the pyramid, and the share of the light that is solved on the next coarser level instead.
struct LatticeChoice {
    int level = 0;
    float share_of_coarser = 0.0f;  // in [0, 1)
};

// How many voxels a lattice has, over how many the series may cost: 1 is full. `extinction`: of its nodes. Smoke of
// extinction sigma fills the volume
//   (integral of sigma)^2 / (integral of sigma^2),
// which smoke too thin to matter hardly changes. Counted are the voxels of that volume, and, with a larger bound, those
// of all that holds smoke.
double lattice_fullness(std::span<const float> extinction);

// What scattering.lattice_level=auto means for this medium alone: the finest level that is not over full. Shortly
// before it is full, the share of the next coarser level rises from 0 to 1, so that the light changes continuously with
// the medium. `corrected`: a bounce on the medium's own lattice follows, so that lattices coarser than that may be
// coarser still.
LatticeChoice automatic_lattice(const ExtinctionPyramid& pyramid, bool corrected);

// The lattice of a series: as stated, or automatic.
LatticeChoice lattice_of_series(const ExtinctionPyramid& pyramid, const ScatteringSettings& settings);

// Of the light of a series, the part that bounces on the medium's own lattice replace
// (ScatteringSettings::fine_bounces): all that was solved on coarser ones.
float share_of_fine_bounces(const LatticeChoice& lattice);

// How much fuller a lattice of this level is, with the number of voxels it may have.
double least_room(int level, bool corrected);

}  // namespace brisance
