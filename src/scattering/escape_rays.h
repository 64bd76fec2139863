// Rays to the edge of the medium, and how much of their light collides on the way.
#pragma once

#include <vector>

#include "medium/lattice/extinction_pyramid.h"

namespace brisance {

// A direction uniform over the sphere, from two numbers in [0, 1).
vec3 uniform_sphere_direction(double u, double v);

// The index of each of `count` systematic picks in proportion to `density`, in order; none where it is zero everywhere.
std::vector<std::size_t> systematic_picks(const std::vector<float>& density, std::size_t count);

// Rays end at the edge of the medium or at a surface. Packed for the marching kernel.
class EscapeRays {
public:
    // `occluders`: the surfaces, or null. Keeps references.
    EscapeRays(const ExtinctionPyramid& pyramid, const Occluders* occluders, std::size_t count);

    // From a position in nodes, relative to the medium's reference node, along a unit direction of local space. May be
    // called for different rays at once.
    void set(std::size_t ray, const vec3& from_nodes, const vec3& direction_local);

    // Per ray, padded to a multiple of 16: 1 - transmittance. Marches with steps of at most one node.
    std::vector<float> collision_probabilities() const;
    // The same, each collision counted with the weight where it happens. `weight`: on the medium's lattice.
    std::vector<float> weighted_collisions(const PackedField& weight) const;

private:
    // The medium's bounding box in nodes from the reference, one node wider.
    struct NodeBox {
        vec3 low, high;
    };
    static NodeBox bounding_box(const Medium& medium);
    // Distance [m] from p along `direction` [nodes per metre] to the box's wall.
    static float exit_distance(const NodeBox& box, const vec3& p, const vec3& direction);

    // Calls `march` with runs of rays, and where their results go.
    template <class March>
    std::vector<float> for_runs(const March& march) const;

    const ExtinctionPyramid& pyramid_;
    const Occluders* occluders_;
    NodeBox box_;
    std::size_t padded_;
    std::vector<float> begin_[3], end_[3];  // per axis, in nodes
    std::vector<float> length_;             // [m]
};

}  // namespace brisance
