// Turns fire into point lights: one light per node of the medium's lattice, with the energy of the field that the
// camera sees.
//
// With hat_i the trilinear hat function of node i,
//   I_i = integral of hat_i(x) j(x) dV,   j = extinction * source + emission,
// where each factor is interpolated on its own. Hats sum to one and reproduce linear functions, so the sum of all I_i
// is the exact integral of j, and their first moment is exact too. The integrand is of degree three per axis in each
// voxel, so a 2-point Gauss rule per axis integrates it without error. The result is then sharpened (sharpen_lights):
// the sum stays exact, and so does the first moment wherever the fire is smooth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "medium/medium.h"

namespace brisance {

// Radiant intensity [W/sr] of every node of the medium's lattice; empty when nothing emits.
std::vector<Rgb> voxel_lights(const Medium& medium);

// The same before it is sharpened, for lights that are splatted to a coarser lattice.
std::vector<Rgb> voxel_lights_unsharpened(const Medium& medium);

// Undoes the spread of h^2/6 per axis that the splat to nodes gives the light, by a conservative flux of
// (I_neighbour - I) / 12 from the darker of two neighbours to the brighter. A node gives away no more than it has, so
// that no light turns negative and the result stays continuous in the data. Without this, light crosses a voxel that
// absorbs e-fold about 8 % too easily. A splat to a lattice twice as coarse, of spacing h, adds h^2/8, so that lights
// have a spread of h^2/6 on whatever lattice they were splatted to. `sharpened_below`: 0, or they were sharpened on a
// lattice so many levels finer, which leaves (1 - 4^-levels) h^2/6.
void sharpen_lights(const BrickLattice& lattice, std::vector<Rgb>& intensity, int sharpened_below = 0);

// The same for any field of values (`channels` interleaved) that are not negative: the flux is `share` of the
// difference, which undoes a spread of 2 share h^2 per axis. At most 1/6.
void sharpen_nodes(const BrickLattice& lattice, std::span<float> values, int channels, float share);

// Replaces `values` (planar, one channel of the lattice's nodes) by node values whose trilinear interpolant has the
// averages of the smooth field through them: it subtracts a twelfth of the second difference per axis. Nodes outside
// `mask` keep their values.
void sharpen_interpolant(const BrickLattice& lattice, const std::vector<std::uint8_t>& mask, std::span<float> values);

// The same projection of extinction * factor, for a factor given at the nodes: scattered light, collisions.
std::vector<Rgb> project_extinction_times(const Medium& medium, const std::vector<Rgb>& factor);

// Sum over all nodes in node order, accumulated in double: independent of the number of threads.
dvec3 total(const std::vector<Rgb>& values);
double total_luminance(const std::vector<Rgb>& values);

}  // namespace brisance
