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

// How much fuller a lattice counts than lattice_fullness() says, at least 1. Where bounces on the medium's own lattice
// follow the series (ScatteringSettings::fine_bounces), it may be coarser. `error`: as of LightingSettings.
double crowding(const ScatteringSettings& settings, float error);

// What scattering.lattice_level=auto means for this medium alone: the finest level that is not over full. Shortly
// before it is full, the share of the next coarser level rises from 0 to 1, so that the light changes continuously with
// the medium.
LatticeChoice automatic_lattice(const ExtinctionPyramid& pyramid, double crowding);

// The lattice of a series: as stated, or automatic.
LatticeChoice lattice_of_series(const ExtinctionPyramid& pyramid, const ScatteringSettings& settings, float error);

// Of the light of a series, the part that bounces on the medium's own lattice replace: all that was solved on coarser
// ones, as far as there are such bounces.
float share_of_fine_bounces(const LatticeChoice& lattice, const ScatteringSettings& settings, float error);

}  // namespace brisance
