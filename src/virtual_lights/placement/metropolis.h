// Light paths mutated by Metropolis sampling: virtual lights that bring equal power to the camera.
//
// [1] B. Segovia, J.-C. Iehl, B. Peroche, Metropolis Instant Radiosity, Eurographics 2007.
// [2] J. Liu, F. Liang, W. Wong, The Multiple-Try Method and Local Optimization in Metropolis Sampling, Journal of the
//     American Statistical Association 95, 2000.
//
// The state of a chain is a deposit of a light path, and a few receivers of the camera. The target is its contribution
// to the picture there,
//     w = contribution + floor * (mean contribution / mean power) * power,
// so that deposits that nobody has seen yet can be reached. Mutations draw anew a whole light path, its last two
// flights, or the receivers alone, several at a time, and one of those is proposed in proportion to w ([2]); as each
// try is drawn independently of the state's own numbers, the tries that were not taken stand in for those of the way
// back. A sample of the chain becomes a light of power P b / (N w), with the mean b of w over plain light paths, which
// a separate estimate gives. Chains begin at deposits of that estimate, in proportion to w: there is no start-up bias.
//
// Departs from [1]: the receivers are several points, so that a light's power follows from what it brings to all of
// them; and the floor keeps the mean right also for lights that none of them sees.
#pragma once

#include "virtual_lights/placement/placement.h"

namespace brisance {

// About settings.count lights, with their power.
PhotonArrivals metropolis_flux(const PlacementInput& input);
// The same, twice as many.
std::vector<Deposit> metropolis_deposits(const PlacementInput& input);

}  // namespace brisance
