// The phase function of Henyey and Greenstein, Diffuse Radiation in the Galaxy, Astrophysical Journal 93, 1941. It
// scatters forward for `mean_cosine` g > 0. Cosines are between the directions of travel before and after scattering.
#pragma once

#include <cmath>

namespace brisance {

constexpr float kPi = 3.14159265358979323846f;

// p(cos) [1/sr], which integrates to 1 over the sphere. Both terms of the denominator are non-negative, so that the
// peak survives as g -> +-1.
inline float henyey_greenstein(float cosine, float g) {
    const float denominator =
        (1.0f - std::abs(g)) * (1.0f - std::abs(g)) + 2.0f * std::abs(g) * (1.0f - (g < 0.0f ? -cosine : cosine));
    return (1.0f - g * g) / (4.0f * kPi * denominator * std::sqrt(denominator));
}

}  // namespace brisance
