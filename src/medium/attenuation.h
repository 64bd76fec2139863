// Attenuation of light along a segment of constant extinction, in closed form.
#pragma once

#include <algorithm>
#include <cmath>

namespace brisance {

// phi1(tau) = (1 - exp(-tau)) / tau, accurate to rounding for every tau >= 0: by its series up to 0.5, which nearly all
// voxels are below, and by expm1.
inline float phi1(float tau) {
    if (tau > 0.5f)
        return -std::expm1(-tau) / tau;
    const float square = tau * tau;
    const float first = 1.0f - tau * (1.0f / 2.0f), second = 1.0f / 6.0f - tau * (1.0f / 24.0f),
                third = 1.0f / 120.0f - tau * (1.0f / 720.0f), fourth = 1.0f / 5040.0f - tau * (1.0f / 40320.0f);
    return (first + square * second) + square * square * (third + square * fourth);
}

// Mean optical depth, from the near end of a segment of depth tau, of light that enters along all of it. Each point is
// weighted by its transmittance: 1 - tau / (exp(tau) - 1).
inline float mean_depth(float tau) {
    return tau < 1e-3f ? 0.5f * tau : 1.0f - tau / std::expm1(std::min(tau, 80.0f));
}

// Beyond this optical depth (transmittance 1e-5) a ray ends; alpha is then 1 to four digits.
constexpr float kOpaqueDepth = 11.5f;

}  // namespace brisance
