// Half of the candidates from light paths, half from the camera's second bounce, resampled by their contribution.
//
// B. Segovia, J.-C. Iehl, R. Mitanchey, B. Peroche, Bidirectional Instant Radiosity, EGSR 2006.
//
// The density of candidates times the weight by which they are resampled is the light that they bring to the picture.
// Light paths leave candidates where light arrives: their weight is what a deposit contributes to points that the
// camera sees. Camera paths leave them where the camera would see light: their weight is the radiance that leaves them
// toward the camera path, by direct light and by some of the candidates of light paths. Either half is chosen from
// equally often.
//
// Departs from the paper: lights are gathered from photons afterwards (flux gathered), as the density of camera paths
// is not known. Candidates are resampled without putting them back, and a tenth of either half regardless of weight.
#pragma once

#include "virtual_lights/placement/placement.h"

namespace brisance {

// About settings.count.
std::vector<Deposit> bidirectional_deposits(const PlacementInput& input);

}  // namespace brisance
