// A number for each node of a lattice, for random numbers that belong to it.
#pragma once

#include <cstdint>

#include "core/vec.h"

namespace brisance {

// Different for nodes within a million of the origin.
inline std::uint64_t node_key(const ivec3& node) {
    const auto part = [](int c) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(c) & 0x1fffffu); };
    return part(node.x) << 42 | part(node.y) << 21 | part(node.z);
}

}  // namespace brisance
