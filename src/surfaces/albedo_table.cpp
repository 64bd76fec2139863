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
constexpr double kGrazing = 0.1;

double angle_coordinate(double alpha, double cosine) {
    return cosine * ((1.0 + alpha) / (cosine + alpha) + (1.0 + kGrazing) / (cosine + kGrazing) + 1.0) / 3.0;
}

double angle_slope(double alpha, double cosine) {
    const auto slope = [cosine](double a) { return (1.0 + a) * a / ((cosine + a) * (cosine + a)); };
    return (slope(alpha) + slope(kGrazing) + 1.0) / 3.0;
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
    if (fraction >= 1.0)
        return 1.0;
    // The coordinate is concave: Newton's steps from 0 never pass the root, and end there.
    double cosine = 0.0;
    for (int i = 0; i < 60; ++i) {
        const double step = (fraction - angle_coordinate(alpha, cosine)) / angle_slope(alpha, cosine);
        if (!(step > 1e-15 * cosine))
            break;
        cosine += step;
    }
    return std::min(cosine, 1.0);
}

}  // namespace brisance
