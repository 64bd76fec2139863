// Real orthonormal spherical harmonics up to degree 2, and the action of a Henyey-Greenstein phase function on them.
#pragma once

#include <array>
#include <cmath>

#include "core/vec.h"

namespace brisance {

constexpr int kShMoments = 8;  // degrees 1 and 2; degree 0 is the fluence
constexpr float kSh0 = 0.28209479177387814f;
constexpr float kSh1 = 0.48860251190291992f;
constexpr float kSh2a = 1.0925484305920792f;
constexpr float kSh2b = 0.31539156525252005f;
constexpr float kSh2c = 0.54627421529603959f;

// Y of degrees 1 (3 values) and 2 (5 values) for a unit direction.
inline std::array<float, kShMoments> sh_basis(const vec3& w) {
    return {kSh1 * w.y,        kSh1 * w.z,
            kSh1 * w.x,        kSh2a * w.x * w.y,
            kSh2a * w.y * w.z, kSh2b * (3.0f * w.z * w.z - 1.0f),
            kSh2a * w.x * w.z, kSh2c * (w.x * w.x - w.y * w.y)};
}

// Scattering multiplies degree l of the incident radiance by g^l: Henyey and Greenstein, Diffuse Radiation in the
// Galaxy, 1941.
inline float sh_phase_factor(int moment, float g) {
    return moment < 3 ? g : g * g;
}

}  // namespace brisance
