// Distances that points should keep, from the points alone.
#pragma once

#include "elimination/leaves.h"

namespace brisance {

// Sets each reach from the distance r_k to the k-th nearest other candidate. With `ratio` candidates per survivor, a
// survivor can expect an area A = ratio pi r_k^2 / k, or a volume V = ratio 4/3 pi r_k^3 / k, of its own.
void reach_by_density(Candidates& candidates, std::size_t k, double ratio, int dimension);

// Returns d_max = 2 r_max of points packed as densely as possible, each with this measure of area (dimension 2) or
// volume (3).
double closest_packing_distance(double measure, int dimension);

}  // namespace brisance
