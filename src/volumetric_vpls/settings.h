// Settings of volumetric virtual point lights: their number, the bound, and its compensation.
#pragma once

#include <cstdint>

namespace brisance {

enum class BiasCompensation {
    None,   // light removed by the bound is lost: too dark
    Exact,  // found by paths: unbiased
    Local   // estimated as if the smoke around every point were homogeneous
};

constexpr double kAutomaticBound = -1.0;

struct VolumetricVplSettings {
    int paths = 65536;                 // particles that are followed
    int count = 131072;                // mean number of collisions kept as lights
    bool roulette_visibility = false;  // what surfaces hide from the camera's rays is kept less often
    int samples = 4;                   // lights evaluated per camera ray and per point of a surface
    double bound = kAutomaticBound;    // of 1 / distance^2 [1/m^2]; 0: unbounded
    BiasCompensation compensation = BiasCompensation::Exact;
    int compensation_samples = 1;  // paths or local estimates per camera ray and per point of a surface
    std::uint32_t seed = 0;
};

}  // namespace brisance
