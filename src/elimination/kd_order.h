// Points in the order of the leaves of a balanced k-d tree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace brisance {

inline constexpr std::size_t kLeafSize = 16;

// How many of `leaves` leaves go to the lower half of a split.
constexpr std::size_t lower_leaves(std::size_t leaves) {
    return leaves - leaves / 2;
}

// A permutation of the points. Each consecutive 16 are a leaf of the tree that splits the longest side of the points'
// box at a multiple of 16 next to the median; ties go by index. Within a leaf the order is unspecified but fixed.
std::vector<std::uint32_t> kd_order(std::span<const vec3> points);

}  // namespace brisance
