// What one virtual light is: a patch of surface and the light that arrives there, to be reflected.
#pragma once

#include <cstdint>

#include "geometry/surface_point.h"

namespace brisance {

struct VirtualLight {
    dvec3 position{0.0};       // local [m]
    ShadingFrame frame;        // around the surface's normal, on the side that is lit
    double radius = 0.0;       // of the sphere within which it covers surfaces [m]
    double clearance = 0.0;    // of its surface (SurfacePoint::clearance) [m]
    double share = 1.0;        // by which its weight is multiplied: below 1 while it fades in or out
    std::uint64_t number = 0;  // of its random numbers
    double area = 0.0;         // covered: surface shared with other lights counts by its weight [m^2]
    double spread = 0.0;       // largest angle of the surface's normals to its own [rad]
    int scene_material = 0;
    SurfaceMaterial material;   // at its position
    Rgb irradiance{0.0f};       // mean over its area [W/m^2]
    dvec3 toward_source{0.0};   // of the flux of one deposit: unit, where that came from
    std::int32_t profile = -1;  // of light reflected, by direction; -1: plain Lambert, `irradiance` is all there is
    Rgb flux{0.0f};             // reflected in all directions [W]
    Rgb base_flux{0.0f};        // ... by the Lambert base alone [W]
    double power = 0.0;         // luminance of the flux [W]
    double intensity = 0.0;     // the largest in any direction, luminance [W/sr]
    double held = 1.0;          // share of paths that end on it, mean over directions (LightSet::held)
};

// Height above the surface at which the visibility of a light is tested, of its radius, as surfaces are not flat.
inline constexpr double kAboveSurface = 1e-3;

// Profiles cannot resolve what smoother surfaces reflect.
inline constexpr float kLeastRoughness = 0.25f;

// Whether virtual lights can hold what a surface reflects. Where not, paths continue.
inline bool holds_light(const SurfaceMaterial& m) {
    if (m.transmission > 0.0f)
        return false;
    return needs_energy_tables(m) ? m.roughness >= kLeastRoughness : m.base_colour != Rgb(0.0f);
}

// The normal on the side that the point was seen from.
inline dvec3 lit_normal(const SurfacePoint& point) {
    return point.front ? point.geometric_normal : -point.geometric_normal;
}

}  // namespace brisance
