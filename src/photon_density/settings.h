// Settings of density estimation by photon points and photon beams.
#pragma once

#include <cstdint>

namespace brisance {

// What is stored, and what it is looked up by: blurred over 3, 2 and 1 dimensions.
enum class DensityEstimator {
    PointPoint,  // photons around points of the ray
    PointBeam,   // photons around the whole ray
    BeamBeam     // flights of photons around the whole ray
};

// Values of `radius` and `alpha` that are derived.
constexpr double kAutomaticBlur = 0.0;
constexpr double kFastestAlpha = 0.0;

struct PhotonDensitySettings {
    DensityEstimator estimator = DensityEstimator::BeamBeam;
    int paths = 400000;              // particles that are followed in each pass
    double radius = kAutomaticBlur;  // of the blur in the first pass [m]
    int passes = 1;                  // pictures that are averaged, each with photons of its own
    double alpha = kFastestAlpha;    // of radius_shrunk(): at 1 the radius stays
    int neighbours = 128;            // photons around a point of a surface, in the first pass
    std::uint32_t seed = 0;
};

}  // namespace brisance
