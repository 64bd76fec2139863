// Flux gathered from all photons around a light: rich lights, which cover surface.
//
// [1] T. Li, W. Wang, D. Lin, C. Yuksel, Virtual Blue Noise Lighting, HPG 2022.
#pragma once

#include "virtual_lights/light_set.h"
#include "virtual_lights/placement/placement.h"

namespace brisance {

class GatheredFlux {
public:
    // Whether the flux is that of the placement's deposits.
    static constexpr bool kFromDeposits = false;

    // Keeps a reference.
    explicit GatheredFlux(const LightSet& set) : set_(set) {}

    // Takes the positions that are shared, or places settings.count lights, measures the area that they cover, and
    // divides photons among them.
    static void build(LightSet& set, const Placement& placement, const LightSources& sources);

    // Along unit `toward` [W/sr].
    Rgb intensity(const VirtualLight& light, const dvec3& toward) const;
    // Of the surface that a light covers [W/(m^2 sr)]; for Lambert surfaces the irradiance [W/m^2], as their colour is
    // that of the point where a ray meets them.
    Rgb surface_light(const VirtualLight& light, const dvec3& toward) const;

private:
    const LightSet& set_;
};

}  // namespace brisance
