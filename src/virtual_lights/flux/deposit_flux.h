// Flux of the one deposit that placed a light: plain virtual point and spherical lights, which cover no surface.
//
// A. Keller, Instant Radiosity, SIGGRAPH 1997.
#pragma once

#include <optional>

#include "virtual_lights/light_set.h"
#include "virtual_lights/placement/placement.h"

namespace brisance {

class DepositFlux {
public:
    // Whether the flux is that of the placement's deposits.
    static constexpr bool kFromDeposits = true;

    explicit DepositFlux(const LightSet&) {}

    // One light for every deposit; the placement's deposits must carry flux. Radius 0, area 1 m^2.
    static void build(LightSet& set, const Placement& placement, const LightSources& sources);

    // Along unit `toward` [W/sr].
    Rgb intensity(const VirtualLight& light, const dvec3& toward) const;
    // The lobes by which directions of glossy light can be sampled; none for Lambert surfaces.
    std::optional<Bsdf> lobes(const VirtualLight& light) const;
};

}  // namespace brisance
