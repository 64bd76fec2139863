// Whether a medium can be lit in the memory that there is, before any of it is taken.
#pragma once

#include <cstdint>
#include <optional>

#include "medium/medium.h"

namespace brisance {

// Bytes that lighting and drawing take at most beside the medium itself, from measurements: so much for each node of
// the lattice of the light, 2^level times as wide as the medium's own, more where light keeps its direction, the shadow
// maps, and what the camera keeps for each node of the medium. `map_bytes`: limit of the maps.
std::uint64_t bytes_to_light(const Medium& medium, bool directional, std::uint64_t map_bytes, int level = 0);

// Throws Error Temporary where `needed` is more than `available`; none: not known.
void check_memory(const Medium& medium, std::uint64_t needed, std::optional<std::uint64_t> available);

}  // namespace brisance
