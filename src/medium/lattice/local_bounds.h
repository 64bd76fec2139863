// The box around a medium's lattice.
#pragma once

#include "medium/medium.h"

namespace brisance {

// Local [m], axes parallel to the world's; of all bricks, however the lattice is rotated or sheared.
struct LocalBounds {
    vec3 low{1e30f}, high{-1e30f};
    // The distance to a point; 0 inside.
    float distance(const vec3& p) const { return glm::length(glm::max(glm::max(low - p, p - high), vec3(0.0f))); }
    vec3 middle() const { return 0.5f * (low + high); }
    float diagonal() const { return glm::distance(low, high); }
};

inline LocalBounds local_bounds(const Medium& medium) {
    LocalBounds bounds;
    const ivec3 first = medium.lattice.min_brick() * BrickLattice::kSize;
    const ivec3 size = medium.lattice.brick_extent() * BrickLattice::kSize;
    for (int k = 0; k < 8; ++k) {
        const vec3 p = medium.local_of_node(first + size * ivec3(k & 1, k >> 1 & 1, k >> 2 & 1));
        bounds.low = glm::min(bounds.low, p);
        bounds.high = glm::max(bounds.high, p);
    }
    return bounds;
}

}  // namespace brisance
