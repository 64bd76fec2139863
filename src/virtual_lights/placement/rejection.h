// Light paths of which those deposits are kept that matter to the picture.
//
// I. Georgiev, P. Slusallek, Simple and Robust Iterative Importance Sampling of Virtual Point Lights, Eurographics 2010
// (short papers). A pilot finds the mean contribution of a deposit to the picture, with visibility. A deposit of
// contribution c survives with probability
//     p = min(c / mean + floor, 1),
// and its power is divided by p: the mean of all is right, and lights bring about the same light to the picture.
#pragma once

#include "virtual_lights/placement/placement.h"

namespace brisance {

// Survivors of light paths, with their power: about settings.count.
PhotonArrivals rejected_flux(const PlacementInput& input);
// The same, twice as many.
std::vector<Deposit> rejected_deposits(const PlacementInput& input);

// The probability above. Where nothing contributes it is 1.
double survival_probability(double contribution, double mean, double floor);

}  // namespace brisance
