// A lighting grid over lights anywhere in space that light a medium from outside.
//
// On every level each light belongs to its nearest vertex and its position enters the vertex's mean. The lights are few
// and far from what they light, so a jump from one vertex to the next does not show. Levels below the top keep only
// lights within range of the medium. A coarse light's centre may lie behind a surface that its lights are in front of.
// Its visibility is therefore that of some of those lights, its parts.
//
// Lights on surfaces send nothing along them. Harmonics of degree 2 do, a tenth of what they send along the normal, and
// smoke near a floor, which sees most of it at grazing angles, would get a tenth more light than there is. Lights
// of a plane therefore shine by the cosine itself; those of curved surfaces by harmonics, the more the more they curve.
#pragma once

#include <vector>

#include "lighting_grid/lighting_grid.h"

namespace brisance {

struct PointLights {
    std::vector<vec3> position;      // local [m]
    std::vector<Rgb> intensity;      // mean over directions [W/sr]
    std::vector<float> directional;  // degrees 1 and 2, 24 per light as GridLevel has them; empty: isotropic
    std::vector<vec3> normal;        // unit, of the lights' surfaces; empty: they have none
    std::size_t size() const { return position.size(); }
};

// Builds as many levels as leave about five vertices along the longest side of all lights; levels[0] is level 0. A
// light of level l is evaluated up to the distance 2 alpha h_l.
LightingGrid build_point_grid(const Medium& medium, const PointLights& lights, float alpha);

}  // namespace brisance
