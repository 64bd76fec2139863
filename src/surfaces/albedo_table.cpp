#include "surfaces/albedo_table.h"

#include <algorithm>
#include <cmath>

#include "surfaces/material.h"

namespace brisance {

namespace {

// From 0 at the smooth limit to 1, by the root of roughness: finer where less is lost.
double roughness_coordinate(double alpha) {
    const double least = std::sqrt(std::sqrt(kSmoothAlpha));
    return std::clamp((std::sqrt(std::sqrt(alpha)) - least) / (1.0 - least), 0.0, 1.0);
}

// A third of the coordinate goes to cosines around alpha, where masking sets in whatever alpha is, a third to those of
// grazing angles, and a third evenly to all, for the critical angle may be anywhere.
double angle_coordinate(double alpha, double cosine) {
    constexpr double grazing = 0.1;
    return cosine * ((1.0 + alpha) / (cosine + alpha) + (1.0 + grazing) / (cosine + grazing) + 1.0) / 3.0;
}

AlbedoLattice::Place place_of(double fraction, int count) {
    const double position = std::clamp(fraction, 0.0, 1.0) * (count - 1);
    const int first = std::min(static_cast<int>(position), count - 2);
    return {first, position - first};
}

}  // namespace

AlbedoLattice::Place AlbedoLattice::by_roughness(double alpha, int count) {
    return place_of(roughness_coordinate(alpha), count);
}

AlbedoLattice::Place AlbedoLattice::by_angle(double alpha, double cosine) {
    return place_of(angle_coordinate(alpha, cosine), kAngles);
}

double AlbedoLattice::alpha_of(int i, int count) {
    const double least = std::sqrt(std::sqrt(kSmoothAlpha));
    const double root = least + (1.0 - least) * double(i) / (count - 1);
    return root * root * root * root;
}

double AlbedoLattice::cosine_of(double alpha, double fraction) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (angle_coordinate(alpha, middle) < fraction ? low : high) = middle;
    }
    return fraction >= 1.0 ? 1.0 : low;
}

}  // namespace brisance
