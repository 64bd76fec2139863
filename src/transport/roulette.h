// Russian roulette: which paths end.
#pragma once

#include <algorithm>

#include "core/rng.h"
#include "core/vec.h"

namespace brisance {

// Paths that carry less than this part of what they began with may be ended.
constexpr float kRouletteBelow = 0.5f;

// Paths between surfaces that lose nothing must end, too; smoke lets them out.
constexpr int kManyScatterings = 64;
constexpr float kGoesOn = 0.95f;

inline float largest(const Rgb& c) {
    return std::max({c.x, c.y, c.z});
}

// Ends the path, or makes up for those that ended. False: ended. `begin`: what it began with; `endless`: nothing else
// may end it.
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
