// Finds points with equal coordinates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace brisance {

// Returns for each point the lowest index among the points with exactly its coordinates.
std::vector<std::uint32_t> first_coincident(std::span<const vec3> points);

}  // namespace brisance
