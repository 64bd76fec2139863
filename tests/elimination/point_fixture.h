// Random points on domains of known measure, and measures of how evenly a selection of them is distributed.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "elimination/eliminate.h"

namespace brisance::testing {

// Uniform in the unit square (z = 0) and the unit cube.
std::vector<vec3> square(std::size_t n, std::uint64_t seed);
std::vector<vec3> cube(std::size_t n, std::uint64_t seed);

// Uniform on the sphere of radius 1, and on the torus of radii 1 and 0.4 about the z axis.
std::vector<vec3> sphere(std::size_t n, std::uint64_t seed);
std::vector<vec3> torus(std::size_t n, std::uint64_t seed);

inline constexpr double kSphereArea = 12.566370614359172;
// stage_ratio of an elimination that has one stage.
inline constexpr double kOneStage = std::numeric_limits<double>::infinity();

inline constexpr double kTorusArea = 15.791367041742974;  // 4 pi^2 1 0.4

EliminationSettings uniform(double measure, int dimension = 2);
EliminationSettings adaptive(int dimension = 2);

std::vector<vec3> chosen(const std::vector<vec3>& points, const Survivors& survivors);

// The distance from each point to its nearest other.
std::vector<double> nearest_distances(const std::vector<vec3>& points);

struct Spread {
    double least, mean;  // distance to the nearest other over d_max of the closest packing
};

// Of points far from the border (at more than `margin` from the sides of the unit square or cube; 0: no border).
Spread spread(const std::vector<vec3>& points, double measure, int dimension = 2, double margin = 0.0);

// Radially averaged power spectrum of points in the unit square, in bins one unit of frequency wide: 1 for random
// points.
std::vector<double> power_spectrum(const std::vector<vec3>& points, int frequencies);

}  // namespace brisance::testing
