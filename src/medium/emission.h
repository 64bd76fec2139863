// Source radiance at a node from the grids' values there.
#pragma once

#include <optional>

#include "medium/blackbody.h"
#include "medium/settings.h"

namespace brisance {

// The grids' values at one node. Absent grids read as 0, an absent colour as white.
struct NodeValues {
    float temperature = 0.0f;  // as stored, not kelvin
    float flame = 0.0f;
    Rgb colour{1.0f};
};

// L_e of a node (conventions: FireSettings). Continuous in every grid value, and 0 at and below the threshold: for
// black-body models the radiance at the threshold is subtracted rather than cut off.
class SourceRadiance {
public:
    explicit SourceRadiance(const FireSettings& settings);
    Rgb operator()(const NodeValues& values) const;

private:
    Rgb blackbody(float temperature) const;

    FireSettings settings_;
    std::optional<Blackbody> blackbody_;
    Rgb at_threshold_{0.0f};
};

// The ramp's colour at `value`: linear between stops, constant beyond them, white without stops.
Rgb ramp_colour(const std::vector<RampStop>& ramp, float value);

}  // namespace brisance
