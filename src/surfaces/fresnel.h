// Reflectance of a plane interface. Cosines are between a direction and the normal of its own side, 0..1.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/vec.h"

namespace brisance {

// Cosine of the refracted ray on the far side, whose index relative to this side is `eta`; none beyond the critical
// angle. Snell's law.
inline std::optional<double> refracted_cosine(double cosine, double eta) {
    const double square = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    if (square <= 0.0)
        return std::nullopt;
    return std::sqrt(square);
}

// Unpolarised reflectance of a dielectric; 1 for total internal reflection. Born and Wolf, Principles of
// Optics, section 1.5.
inline double dielectric_fresnel(double cosine, double eta) {
    if (eta == 1.0)
        return 0.0;  // at grazing incidence 0 / 0 below
    const std::optional<double> far = refracted_cosine(cosine, eta);
    if (!far)
        return 1.0;
    const double parallel = (eta * cosine - *far) / (eta * cosine + *far);
    const double perpendicular = (cosine - eta * *far) / (cosine + eta * *far);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

inline double normal_reflectance(double eta) {
    const double r = (eta - 1.0) / (eta + 1.0);
    return r * r;
}

// 0 at normal incidence, 1 at grazing incidence and beyond the critical angle: it blends F0 to F90 instead of
// Schlick's (1 - cos)^5, so that a specular weight of 1 and a white colour are Fresnel's equations themselves.
inline double dielectric_blend(double cosine, double eta) {
    const double f0 = normal_reflectance(eta);
    return std::max(0.0, (dielectric_fresnel(cosine, eta) - f0) / (1.0 - f0));
}

// Schlick, An Inexpensive BRDF Model for Physically-Based Rendering, 1994; F90 = 1.
inline Rgb schlick_fresnel(const Rgb& f0, double cosine) {
    const double x = std::clamp(1.0 - cosine, 0.0, 1.0);
    const float blend = static_cast<float>(x * x * x * x * x);
    return f0 + (Rgb(1.0f) - f0) * blend;
}

// Its mean over the hemisphere, weighted by the cosine.
inline Rgb mean_schlick_fresnel(const Rgb& f0) {
    return f0 + (Rgb(1.0f) - f0) / 21.0f;
}

}  // namespace brisance
