// The Henyey-Greenstein phase function. `mean_cosine` g > 0 scatters forward; cosines are between the directions of
// travel before and after the scattering.
#pragma once

#include <cmath>

namespace brisance {

constexpr float kPi = 3.14159265358979323846f;

// p(cos) [1/sr], integrates to 1 over the sphere. Written so that g -> +-1 keeps its peak: the denominator's terms are
// both non-negative.
inline float henyey_greenstein(float cosine, float g) {
    const float denominator =
        (1.0f - std::abs(g)) * (1.0f - std::abs(g)) + 2.0f * std::abs(g) * (1.0f - (g < 0.0f ? -cosine : cosine));
    return (1.0f - g * g) / (4.0f * kPi * denominator * std::sqrt(denominator));
}

}  // namespace brisance
