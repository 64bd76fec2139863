// Volumetric virtual point lights: how many, how near they may shine, and what makes up for that.
#pragma once

#include <cstdint>

namespace brisance {

enum class BiasCompensation {
    None,   // what the bound takes away is lost: too dark
    Exact,  // found by paths: unbiased
    Local   // guessed as if the smoke around every place were alike
};

constexpr double kAutomaticBound = -1.0;

struct VolumetricVplSettings {
    int paths = 65536;               // particles that are followed
    int count = 131072;              // of their collisions that are kept as lights, on average
    int samples = 4;                 // lights that a camera ray, or a point of a surface, asks
    double bound = kAutomaticBound;  // of 1 / distance^2 [1/m^2]; 0: unbounded
    BiasCompensation compensation = BiasCompensation::Exact;
    int compensation_samples = 1;  // paths, or guesses, on a camera ray and at a point of a surface
    std::uint32_t seed = 0;
};

}  // namespace brisance
