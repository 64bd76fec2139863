// Thermal radiance as linear Rec. 709.
#pragma once

#include <vector>

#include "core/vec.h"

namespace brisance {

enum class BlackbodyScale {
    Absolute,   // Planck's law [W/(m^2 sr)], weighted by the colour matching functions
    Normalized  // the spectrum divided by its own maximum: colour and soft brightness without the T^4
};

// Planck's law integrated against the CIE 1931 observer [1] and converted to linear Rec. 709, tabulated over
// temperature. Luminance Y is the integral of B y-bar [W/(m^2 sr)] (absolute), or that of B / max B divided by the
// integral of y-bar (normalised). Colours outside the gamut (reds below some 1900 K) have their negative channels set
// to 0. [1] Wyman, Sloan, Shirley, Simple Analytic Approximations to the CIE XYZ Color Matching Functions, JCGT 2(2),
// 2013.
class Blackbody {
public:
    explicit Blackbody(BlackbodyScale scale);
    Rgb radiance(float kelvin) const;  // 0 at and below 50 K, constant above 1e6 K

private:
    std::vector<vec3> log_xyz_;  // over equal steps of ln T
};

}  // namespace brisance
