// The material of a surface in the terms of glTF 2.0: metallic-roughness (section 3.9.2) with
// KHR_materials_transmission, _ior and _specular. Emission is not part of it.
#pragma once

#include "core/vec.h"

namespace brisance {

// Below this alpha (roughness 0.01) an interface is smooth: its lobes are deltas.
constexpr double kSmoothAlpha = 1e-4;

// Below this index of refraction the interface is matched: nothing is reflected (less than 3e-7 would be), and light
// continues straight on.
constexpr double kMatchedIor = 1.001;

struct SurfaceMaterial {
    Rgb base_colour{1.0f};      // [1] 0..1: of the diffuse base, of metal at normal incidence, of what is transmitted
    float metallic = 0.0f;      // [1] 0..1: share of the surface that is metal
    float roughness = 1.0f;     // [1] 0..1: square root of GGX's alpha
    float ior = 1.5f;           // [1] 1..10: index of the inside relative to the outside
    float specular = 1.0f;      // [1] 0..1: factor of the dielectric's reflection at any angle
    Rgb specular_colour{1.0f};  // [1] >= 0: factor of its reflection at normal incidence, which stays below 1
    float transmission = 0.0f;  // [1] 0..1: share of the dielectric that refracts instead of scattering diffusely
    bool thin = false;          // light is transmitted as through a sheet, without refraction
};

// Whether some light scatters diffusely.
inline bool has_base(const SurfaceMaterial& m) {
    return m.metallic < 1.0f && m.transmission < 1.0f && m.base_colour != Rgb(0.0f);
}

// A plain Lambert surface needs no energy tables.
inline bool needs_energy_tables(const SurfaceMaterial& m) {
    return m.metallic > 0.0f || m.specular > 0.0f || m.transmission > 0.0f;
}

// Nor does any but rough glass need those of interfaces.
inline bool needs_interface_tables(const SurfaceMaterial& m) {
    return m.transmission > 0.0f && m.metallic < 1.0f && !m.thin && m.ior >= kMatchedIor &&
           double(m.roughness) * m.roughness >= kSmoothAlpha;
}

}  // namespace brisance
