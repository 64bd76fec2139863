// The area of surface that a virtual light covers.
#pragma once

#include <cstdint>

#include "virtual_lights/flux/partition_of_unity.h"

namespace brisance {

// Sets `area` and `spread` of every light: the integral of its weight over the surfaces in its sphere, by rays along
// its normal. The relative standard error is a few per cent per light. Returns 1 for lights whose area is measured so.
// For others, whose surface the rays hardly found (a leaf in a wide sphere), `area` is at least what one ray stands
// for.
std::vector<std::uint8_t> measure_areas(const Intersector& surfaces, const PartitionOfUnity& partition,
                                        std::span<VirtualLight> lights, std::uint32_t seed);

}  // namespace brisance
