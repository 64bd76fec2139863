// Values at a few points of a brick, and at its nodes by interpolation.
#pragma once

#include "medium/lattice/brick_lattice.h"

namespace brisance {

// Points `kIntervals` + 1 along each side of a brick, shared with the next; between them values are trilinear.
template <int kIntervals>
struct BrickPoints {
    static constexpr int kSide = kIntervals + 1, kCount = kSide * kSide * kSide;
    static constexpr int kStep = BrickLattice::kSize / kIntervals;

    static ivec3 node(int point) {
        return kStep * ivec3(point / (kSide * kSide), point / kSide % kSide, point % kSide);
    }
    static float at(const float* values, int offset) {
        const ivec3 n = BrickLattice::node_in_brick(offset), low = n / kStep;
        const vec3 part = vec3(n - low * kStep) / float(kStep);
        float sum = 0.0f;
        for (int k = 0; k < 8; ++k) {
            const ivec3 corner(k >> 2, k >> 1 & 1, k & 1);
            const ivec3 p = low + corner;
            const vec3 w = glm::mix(1.0f - part, part, vec3(corner));
            sum += w.x * w.y * w.z * values[(p.x * kSide + p.y) * kSide + p.z];
        }
        return sum;
    }
};

}  // namespace brisance
