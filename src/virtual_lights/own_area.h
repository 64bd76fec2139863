// How much surface a virtual light speaks for.
#pragma once

#include <cstdint>

#include "virtual_lights/cover.h"

namespace brisance {

// Sets `area` and `spread` of every light: the integral of its weight over the surfaces in its sphere, by rays along
// its normal. Relative standard error 2 % or so per light.
void measure_areas(const Intersector& surfaces, const LightCover& cover, std::span<VirtualLight> lights,
                   std::uint32_t seed);

}  // namespace brisance
