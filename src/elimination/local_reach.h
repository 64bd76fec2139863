// How far points should be apart where nothing is known but the points themselves.
#pragma once

#include "elimination/leaves.h"

namespace brisance {

// Sets each reach from the distance r_k to the k-th nearest other candidate. With `ratio` of candidates to survivors a
// survivor may expect A = ratio pi r_k^2 / k of the surface, or V = ratio 4/3 pi r_k^3 / k of the space, to itself.
void reach_by_density(Candidates& candidates, std::size_t k, double ratio, int dimension);

// d_max = 2 r_max of points that fill an area (dimension 2) or a volume (3) of that measure each as densely as
// possible.
double closest_packing_distance(double measure, int dimension);

}  // namespace brisance
