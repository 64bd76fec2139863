// The weight that one point adds to another, as an integer. Sums and differences are exact, so a weight depends on the
// remaining points and not on the order in which the others were removed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace brisance {

// In units of 2^-30. A sum over 2^32 coincident points still fits.
using Weight = std::int64_t;

inline constexpr float kWeightUnit = 0x1p30f;

// 1 / d_max, finite where d_max is 0.
inline float inverse_reach(float reach, float scale) {
    return 1.0f / std::max(reach * scale, 1e-30f);
}

// (1 - max(d / d_max, least))^8 for a neighbour at the square distance d^2 ([1] of eliminate.h, eq. 2 with alpha = 8).
// Written as leaf_kernels.cpp writes it, operation by operation.
inline std::int32_t pair_weight(float square_distance, float inverse_reach, float least) {
    const float t = std::max(std::sqrt(square_distance) * inverse_reach, least);
    const float u = std::max(1.0f - t, 0.0f);
    const float square = u * u, fourth = square * square;
    return static_cast<std::int32_t>(std::lrintf(fourth * fourth * kWeightUnit));
}

}  // namespace brisance
