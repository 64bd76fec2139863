// How much surface a virtual light speaks for.
#pragma once

#include <cstdint>

#include "virtual_lights/partition_of_unity.h"

namespace brisance {

// Sets `area` and `spread` of every light: the integral of its weight over the surfaces in its sphere, by rays along
// its normal. Relative standard error a few per cent per light. Returns 1 for lights whose area is known so; for
// others, of which hardly anything was found (a leaf in a wide sphere), `area` is at least what one ray stands for.
std::vector<std::uint8_t> measure_areas(const Intersector& surfaces, const PartitionOfUnity& cover,
                                        std::span<VirtualLight> lights, std::uint32_t seed);

}  // namespace brisance
