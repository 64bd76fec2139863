// Points at the same place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace brisance {

// For each point, the lowest index among the points at exactly its place.
std::vector<std::uint32_t> first_at_place(std::span<const vec3> points);

}  // namespace brisance
