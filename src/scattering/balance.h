// Estimates for the energy balance of a flight: what is emitted either collides or escapes.
#pragma once

#include <span>
#include <vector>

#include "lighting_grid/footprint.h"
#include "medium/lattice/extinction_pyramid.h"
#include "medium/sh.h"

namespace brisance {

// Collisions are counted themselves, not as what does not escape: in thin smoke 1 - escape would be rounding.
struct CollisionEstimate {
    dvec3 fraction{0.0};          // of the emitted power that collides before it leaves the medium, per colour
    double standard_error = 0.0;  // of the luminance's
    std::size_t rays = 0;
};

// The same of a part of the collisions.
struct PartlyCollided {
    CollisionEstimate all, part;
};

// `rays` rays start at the lights' nodes in proportion to luminance, systematically over the nodes' order, and leave in
// stratified directions; each carries what its march to the edge of the medium absorbs and scatters. `directional`:
// degrees 1 and 2 of the lights, 24 per node (sh.h), or none. Unbiased for the node lights but for the march's step.
// The spread of interleaved batches gives the standard error.
CollisionEstimate estimate_collisions(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& intensity,
                                      std::span<const float> directional, std::size_t rays);
// `part`: how much a collision at a node counts in the part's estimate, in [0, 1].
PartlyCollided estimate_collisions(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& intensity,
                                   std::span<const float> directional, std::size_t rays,
                                   const std::vector<float>& part);

// Power that would leave the medium without surfaces, over 4 pi [W/sr], by as many rays, which start more often where
// `likelihood` (per node, any positive guess of how much escapes there) is high: where all but little is swallowed, the
// estimate above knows the little badly.
struct EscapeEstimate {
    dvec3 power{0.0};
    double standard_error = 0.0;  // of the luminance's, relative
};
EscapeEstimate estimate_escape(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& intensity,
                               std::span<const float> directional, const std::vector<float>& likelihood,
                               std::size_t rays);

// Radiant intensity of a node's light in a direction of local space [W/sr]. `directional`: 24 per node, or none.
dvec3 directional_intensity(const std::vector<Rgb>& intensity, std::span<const float> directional, std::size_t node,
                            const vec3& direction);

// Power that collides, is absorbed or scattered, over 4 pi [W/sr]: the exact integral of extinction * fluence of the
// two interpolated fields. Of a share of each node's fluence. And the part of it that is absorbed: the same with
// (1 - albedo) * fluence.
dvec3 collided_power(const Medium& medium, const std::vector<Rgb>& fluence);
dvec3 collided_power(const Medium& medium, std::vector<Rgb> fluence, const std::vector<float>& share);
dvec3 absorbed_power(const Medium& medium, std::vector<Rgb> fluence);

// Where light at a vertex of the lattice 2^level coarser starts: nodes under its hat, picked by extinction. The vertex
// itself on the medium's own lattice, and where no node under its hat has extinction: light between two nodes is
// emitted at both of them.
std::vector<ivec3> nodes_of_vertex(FootprintPicker& picker, const ivec3& vertex, int level, int count);

// Collision probability over all directions and over what each vertex stands for: `directions` stratified rays per
// vertex (of the lattice 2^level coarser than the medium's), each from one of nodes_of_vertex().
// `numbers` per vertex: the mean alone (1), or also those of the probability times sh_basis (kCollisionMoments). What
// collides of a directional light is the sum of its coefficients times these.
constexpr int kCollisionMoments = 1 + kShMoments;
std::vector<float> collision_probabilities(const ExtinctionPyramid& pyramid, const std::vector<ivec3>& vertices,
                                           int level, int directions, int numbers = 1);

}  // namespace brisance
