// Solutions of radiative transfer without a renderer: closed forms, and integral equations of one variable.
#pragma once

#include <functional>
#include <vector>

#include "core/vec.h"

namespace brisance::stability {

constexpr double kExactPi = 3.14159265358979323846;

// 1 - exp(-depth): radiance of a ray through an isothermal absorber, as a part of its source function.
double one_minus_transmittance(double depth);

// Chandrasekhar's H for isotropic scattering, by iterating
//   1/H(mu) = sqrt(1 - albedo) + albedo/2 integral over [0, 1] of m H(m) / (mu + m) dm.
double chandrasekhar_h(double albedo, double mu);

// Radiance toward `mu` (cosine with the normal) of an isothermal half-space, as a part of B: sqrt(1 - albedo) H(mu).
double isothermal_half_space(double albedo, double mu);

// A homogeneous ball that scatters isotropically and emits uniformly. Lengths in mean free paths, radiance as a part of
// `emission`, the emitted part of the source function: the source function S solves, with f(x) = x S(x) odd,
//   f(x) = emission x + albedo/2 integral over [-radius, radius] of E1|x - y| f(y) dy.
// Solved for piecewise linear f on a grid that is finer toward the surface; accurate to about 1e-4.
class ScatteringBall {
public:
    ScatteringBall(double radius, double albedo, double emission);

    double source(double r) const;
    double radiance(double impact) const;  // of a ray that passes the centre at this distance
    double radiance_from_centre() const;   // of any ray that starts there
    // Power that leaves, over 4 pi, in units of radiance times a squared mean free path.
    double power() const;

private:
    double radius_;
    std::vector<double> x_, f_;
};

// Radiance scattered once toward the eye from an isotropic point light of unit intensity in a homogeneous medium, along
// [begin, end] of a ray; `nearest` is the distance along the ray of the point nearest the light, `offset` its distance
// from the light. Coefficients in 1/m, lengths in m.
double airlight(double extinction, double scattering, double begin, double end, double nearest, double offset);

// Luminance (Y, as the renderer's absolute black body) of Planck's law under the tabulated CIE 1924 V(lambda)
// [W/(m^2 sr)].
double blackbody_luminance(double kelvin);

// Midpoint rule.
double integrate(const std::function<double(double)>& f, double begin, double end, int steps);

}  // namespace brisance::stability
