// Russian roulette: termination of paths.
#pragma once

#include <algorithm>

#include "core/rng.h"
#include "core/vec.h"

namespace brisance {

// Paths whose throughput falls below this fraction of its initial value may be terminated.
constexpr float kRouletteBelow = 0.5f;

// Number of scatterings after which paths between surfaces may be terminated although they lose nothing; smoke lets
// them out.
constexpr int kManyScatterings = 64;
constexpr float kGoesOn = 0.95f;

// The same of particles that collide with smoke, which lets them out late: light that starts in smoke of albedo 1 and
// an optical radius R takes R^2 / 5 collisions in the mean. What is cut is in few, bright particles: most pictures lack
// it.
constexpr int kManyCollisions = 512;

inline float largest(const Rgb& c) {
    return std::max({c.x, c.y, c.z});
}

// Terminates the path, or compensates for the terminated ones. False: terminated. `begin`: initial throughput;
// `endless`: nothing else may end the path.
inline bool survives(Rgb& throughput, float begin, bool endless, Rng& rng) {
    float part = largest(throughput) / begin;
    if (endless)
        part = std::min(part, kGoesOn);
    else if (part >= kRouletteBelow)
        return true;
    if (!(rng.next() < part))
        return false;
    throughput /= part;
    return true;
}

}  // namespace brisance
