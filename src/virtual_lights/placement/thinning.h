// From many deposits to few virtual lights.
#pragma once

#include "elimination/eliminate.h"
#include "virtual_lights/placement/deposit.h"
#include "virtual_lights/settings.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

// At most settings.count positions, with the distance that each keeps from others. By weighted sample elimination:
Survivors thin_to_blue_noise(const std::vector<vec3>& positions, const VirtualLightSettings& settings);
// ... and by chance alone:
Survivors thin_at_random(const std::vector<vec3>& positions, const VirtualLightSettings& settings);

// For ways of thinning: settings.count of as many positions, by chance, ascending.
std::vector<std::uint32_t> random_subset(std::size_t of, const VirtualLightSettings& settings);
// ... and of those chosen the distances that they would keep in closest packing at their own density.
Survivors with_distances(std::vector<std::uint32_t> index, const std::vector<vec3>& positions,
                         const VirtualLightSettings& settings);

// A light that has a position but no radius.
VirtualLight light_at(const Scene& scene, const Deposit& deposit);

}  // namespace brisance
