// Wide lobes around the normal (z): densities [1/sr], and directions drawn by them from two numbers in [0, 1).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/vec.h"

namespace brisance {

// Lambert's lobe: its value times the cosine, and the density that draws it [1/sr].
inline double cosine_density(double cosine) {
    return cosine / std::numbers::pi;
}

inline dvec3 sample_cosine(double u, double v) {
    const double radius = std::sqrt(u), azimuth = 2.0 * std::numbers::pi * v;
    return {radius * std::cos(azimuth), radius * std::sin(azimuth), std::sqrt(1.0 - u)};
}

// Light that met more than one facet leaves in proportion to cos (1 - E), and 1 - E about as alpha^2 / (cos^2 +
// alpha^2) (masking loses alpha^2 tan^2 / 4 far from grazing angles): for low roughness almost along the surface, where
// a cosine lobe has few samples.
inline double grazing_density(double cosine, double alpha) {
    const double square = alpha * alpha;
    return cosine / (std::numbers::pi * (cosine * cosine + square) * std::log1p(1.0 / square));
}

inline dvec3 sample_grazing(double alpha, double u, double v) {
    const double square = alpha * alpha;
    const double cosine = std::min(1.0, alpha * std::sqrt(std::expm1(u * std::log1p(1.0 / square))));
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine)), azimuth = 2.0 * std::numbers::pi * v;
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

}  // namespace brisance
