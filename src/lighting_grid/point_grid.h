// A lighting grid over lights anywhere in space: those that light a medium from outside.
//
// Each light belongs to the vertex nearest to it on every level, with its place in the mean: they are few and far from
// what they light, and moving from one vertex to the next at once does not show. Levels below the top keep only lights
// that the medium may ask them for. A coarse light's centre may lie behind a surface that its lights are in front of:
// surfaces hide it as far as they hide some of those, its parts.
#pragma once

#include <vector>

#include "lighting_grid/lighting_grid.h"

namespace brisance {

struct PointLights {
    std::vector<vec3> position;      // local [m]
    std::vector<Rgb> intensity;      // mean over directions [W/sr]
    std::vector<float> directional;  // degrees 1 and 2, 24 per light as GridLevel has them; empty: isotropic
    std::size_t size() const { return position.size(); }
};

// levels[0] is level 0. As many levels as leave about five vertices along the longest side of all lights. `alpha`: a
// light of level l serves up to 2 alpha h_l.
LightingGrid build_point_grid(const Medium& medium, const PointLights& lights, float alpha);

}  // namespace brisance
