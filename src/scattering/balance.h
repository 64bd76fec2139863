// The energy balance of a bounce: what is emitted either collides or escapes.
#pragma once

#include <vector>

#include "medium/extinction_pyramid.h"

namespace brisance {

struct EscapeEstimate {
    dvec3 fraction{0.0};  // of the emitted power that leaves the medium without a collision, per colour
    dvec3 collided{0.0};  // the rest, summed by itself: in thin smoke 1 - fraction would be rounding alone
    double standard_error = 0.0;  // of the luminance's
    std::size_t rays = 0;
};

// `rays` rays start at the lights' nodes in proportion to luminance, systematically over the nodes' order, and leave in
// stratified directions; each carries its marched transmittance to the edge of the medium. Unbiased for the node lights
// but for the march's step. Two halves give the standard error.
EscapeEstimate estimate_escape(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& intensity, std::size_t rays);

// Power absorbed and scattered, over 4 pi: the exact integral of extinction * fluence of the two interpolated fields.
dvec3 collided(const Medium& medium, const std::vector<Rgb>& fluence);

// Collision probability, averaged over all directions, of light that sets out from vertices of the lattice 2^level
// coarser than the medium's: `directions` stratified rays each, from the nodes under the vertex' hat picked by
// extinction, or from the vertex where there is none or the lattices are the same.
std::vector<float> collision_probabilities(const ExtinctionPyramid& pyramid, const std::vector<ivec3>& vertices,
                                           int level, int directions);

// The same of the light of a source function that is 1 at the vertex and falls to 0 at its neighbours: rays start
// anywhere under the hat, in proportion to hat times extinction. Sums of source times this are what the camera sees
// leave, however steeply extinction rises.
std::vector<float> collision_probabilities_of_hats(const ExtinctionPyramid& pyramid, const std::vector<ivec3>& vertices,
                                                   int level, int directions);

}  // namespace brisance
