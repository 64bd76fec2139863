// The estimators that all tests of photons go through.
#pragma once

#include "photon_density/settings.h"

namespace brisance::testing {

constexpr DensityEstimator kEstimators[] = {DensityEstimator::PointPoint, DensityEstimator::PointBeam,
                                            DensityEstimator::BeamBeam};

inline const char* name_of(DensityEstimator estimator) {
    return estimator == DensityEstimator::PointPoint  ? "points in balls"
           : estimator == DensityEstimator::PointBeam ? "points in discs"
                                                      : "beams";
}

}  // namespace brisance::testing
