// The fuel: irregular puffs thrown up from a small area on the ground within a fraction of a second.
#pragma once

#include <vector>

#include "field.h"
#include "settings.h"

namespace brisance::combustion {

struct Puff {
    vec3 centre;     // world [m]
    vec3 velocity;   // of its gas as it enters [m/s]
    float radius;    // mean [m]
    float start;     // [s]
    float duration;  // [s]
    float richness;  // fuel in its gas [mass fraction]: poor puffs burn out while rich ones still glow
    std::uint32_t seed;

    // Depth below the puff's ragged surface [m]; negative outside.
    float depth(const vec3& world) const;
};

std::vector<Puff> make_puffs(const Settings& settings);

}  // namespace brisance::combustion
