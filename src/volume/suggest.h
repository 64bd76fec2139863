// Guesses a first look for a file without a shot from its numbers alone.
#pragma once

#include <string>
#include <vector>

#include "core/vec.h"
#include "volume/vdb_file.h"

namespace brisance {

// What is known of a grid that plays a role.
struct MeasuredGrid {
    GridInfo info;
    GridCensus census;
};

enum class SuggestedFire { None, Flame, Blackbody };

struct SuggestedLook {
    float extinction_per_metre = 1.0f;    // of density 1 [1/m]; two significant digits
    float max_density = 0.0f;             // in the grid's own values
    float max_flame = 0.0f;               // in the grid's own values
    vec2 temperature_in{0.0f, 1.0f};      // grid values ...
    vec2 temperature_kelvin{0.0f, 1.0f};  // ... and what they stand for [K]
    SuggestedFire fire = SuggestedFire::None;
    bool emission_follows_density = true;  // false: the fire reaches beyond the smoke, so it must shine without it
    std::vector<std::string> notes;        // why, one line each
};

// A null pointer means that no grid plays this role. The result depends on the arguments alone, so guess once for a
// sequence: separate guesses would flicker.
SuggestedLook suggest_look(const MeasuredGrid* density, const MeasuredGrid* flame, const MeasuredGrid* temperature);

}  // namespace brisance
