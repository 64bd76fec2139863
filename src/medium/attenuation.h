// Attenuation of light along a segment of constant extinction, in closed form.
#pragma once

#include <algorithm>
#include <cmath>

namespace brisance {

// phi1(tau) = (1 - exp(-tau)) / tau, accurate to rounding for every tau >= 0 by expm1, and by its series near zero.
inline float phi1(float tau) {
    return tau < 1e-3f ? 1.0f - tau * (0.5f - tau * (1.0f / 6.0f)) : -std::expm1(-tau) / tau;
}

// Mean optical depth, from the near end of a segment of depth tau, of light that enters along all of it. Each point is
// weighted by its transmittance: 1 - tau / (exp(tau) - 1).
inline float mean_depth(float tau) {
    return tau < 1e-3f ? 0.5f * tau : 1.0f - tau / std::expm1(std::min(tau, 80.0f));
}

// Beyond this optical depth (transmittance 1e-5) a ray ends; alpha is then 1 to four digits.
constexpr float kOpaqueDepth = 11.5f;

}  // namespace brisance
