// How far points on surfaces lie from each other.
#pragma once

#include <vector>

#include "core/vec.h"

namespace brisance {

// The area that closest packing gives to a point that keeps its distance: a hexagon.
double area_of_distance(double distance);

// The distances [m] that the points would keep from others in closest packing at the density of each one's
// surroundings: from the distance to its k-th nearest. 0 for points that lie where others do and for a single one.
std::vector<float> packing_distances(const std::vector<vec3>& points, int neighbours);

// To the k-th nearest [m], or to the farthest where there are fewer. Points that lie where others do get the mean of
// all; a single one 0.
std::vector<double> distances_to_nearest(const std::vector<vec3>& points, int k);

}  // namespace brisance
