// Transmittance and free flights in the medium along one ray. Distances are metres along the ray; all estimators are
// unbiased for the trilinear field itself, and the tests hold them against one another.
#pragma once

#include <optional>

#include "core/rng.h"
#include "tracking/tracking_field.h"

namespace brisance {

// The fraction of a segment in one voxel at which the optical depth reaches `depth`; `metres` is the segment's length,
// and the depth of the whole segment is at least `depth`.
double invert_depth(const Cubic& extinction, double metres, double depth);

// Optical depth of [0, end], exact up to rounding.
double optical_depth(const TrackingField& field, const Ray& ray, double end);
// Of a medium whose bricks have their mean extinction throughout: a guess, at the cost of a step for every brick.
double coarse_depth(const TrackingField& field, const Ray& ray, double end);

struct Collision {
    double distance;
    std::size_t brick;
    vec3 position;  // in nodes from the brick's first node
};

// The next collision, if there is one in the brick or before `end` [m]: by Woodcock's null collisions against each
// brick's majorant (Woodcock et al. 1965). Bricks so uneven that null collisions would outnumber their voxels many
// times are walked by inverting the optical depth of each voxel. LineTracker can do so everywhere.
std::optional<Collision> null_collision_in_brick(const TrackingField& field, const VoxelSegment& brick, Rng& rng);
std::optional<Collision> null_collision_flight(const TrackingField& field, const Ray& ray, double end, Rng& rng);

// Ratio tracking (Cramer 1978; Novak, Selle, Jarosz 2014): the product of 1 - extinction / majorant over tentative
// collisions. Variance T^2 (exp(integral of extinction^2 / majorant) - 1).
double ratio_tracking(const TrackingField& field, const LatticeRay& ray, Rng& rng);

// Unbiased ray marching (Kettunen, d'Eon, Pantaleoni, Novak, An unbiased ray-marching transmittance estimator, 2021):
// jittered combs of samples give independent estimates of the optical depth; a truncated power series with Russian
// roulette on its order undoes the bias of exponentiating one of them.
double unbiased_ray_march(const TrackingField& field, const LatticeRay& ray, Rng& rng);

}  // namespace brisance
