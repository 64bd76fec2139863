// Flux of the one deposit that placed a light: plain virtual point and spherical lights, which cover no surface.
//
// A. Keller, Instant Radiosity, SIGGRAPH 1997.
#pragma once

#include <optional>

#include "virtual_lights/light_set.h"
#include "virtual_lights/placement/placement.h"

namespace brisance {

// A light of radius 0 and area 1 m^2 that holds what arrives at the deposit. Of its flux only what deposit_intensity()
// reads is known.
VirtualLight light_of_deposit(const Scene& scene, const Deposit& deposit);
// Reflected along unit `toward` [W/sr].
Rgb deposit_intensity(const VirtualLight& light, const dvec3& toward);

class DepositFlux {
public:
    // Whether the flux is that of the placement's deposits.
    static constexpr bool kFromDeposits = true;

    explicit DepositFlux(const LightSet&) {}

    // One light for every deposit; the placement's deposits must carry flux. Radius 0, area 1 m^2.
    static void build(LightSet& set, const Placement& placement, const LightSources& sources);

    // Along unit `toward` [W/sr].
    Rgb intensity(const VirtualLight& light, const dvec3& toward) const { return deposit_intensity(light, toward); }
    // The lobes by which directions of glossy light can be sampled; none for Lambert surfaces.
    std::optional<Bsdf> lobes(const VirtualLight& light) const;
};

}  // namespace brisance
