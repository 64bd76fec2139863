#include "medium_lighting/stages/lamp_in_voxel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

constexpr int kAcross = 4;

// Means over a ball of radius 1, at the distance r from the lamp.
struct BallMeans {
    double square;  // of 1 / s^2
    double flux;    // of the vector that points away from the lamp and is 1 / s^2 long: as gravity in and around a ball
    double inverse;  // of 1 / s, the potential
};

BallMeans means_over_ball(double r) {
    const double logarithm =
        std::abs(1.0 - r) > 1e-9 ? (1.0 - r * r) / (2.0 * r) * std::log((1.0 + r) / std::abs(1.0 - r)) : 0.0;
    const bool inside = r < 1.0;
    return {1.5 * (1.0 + logarithm), inside ? r : 1.0 / (r * r), inside ? 1.5 - 0.5 * r * r : 1.0 / r};
}

}  // namespace

LampInVoxel lamp_in_voxel(const mat3& local_from_index, const vec3& from_lamp) {
    constexpr int kParts = kAcross * kAcross * kAcross;
    const double volume = std::abs(double(glm::determinant(local_from_index))) / kParts;
    const double radius = std::cbrt(0.75 / std::numbers::pi * volume);
    double square = 0.0, inverse = 0.0;
    dvec3 flux(0.0);
    for (int k = 0; k < kParts; ++k) {
        const vec3 part =
            (vec3(float(k % kAcross), float(k / kAcross % kAcross), float(k / (kAcross * kAcross))) + 0.5f) /
                float(kAcross) -
            0.5f;
        const dvec3 way = dvec3(from_lamp + local_from_index * part) / radius;
        const double r = std::max(glm::length(way), 1e-6);
        const BallMeans means = means_over_ball(r);
        square += means.square / kParts;
        inverse += means.inverse / kParts;
        flux += means.flux / kParts / r * way;
    }
    const double distance = double(glm::length(from_lamp));
    return {square * std::pow(distance / radius, 2.0), vec3(flux / square), radius * inverse / square - distance};
}

double transmittance_within(double depth) {
    return depth > 1e-6 ? -std::expm1(-2.0 * depth) / (2.0 * depth) : std::exp(-depth);
}

}  // namespace brisance
