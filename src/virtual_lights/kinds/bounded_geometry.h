// Bounds of virtual point lights: on the geometry term, G_b = min(G, b), and on all that a light adds to a vertex.
//
// A. Keller, Instant Radiosity, SIGGRAPH 1997, has the singularity; T. Kollig, A. Keller, Illumination in the Presence
// of Weak Singularities, Monte Carlo and Quasi-Monte Carlo Methods 2004, bounds it and finds the rest by paths:
//     T L = T_b L + T_r L,   T_r L(x) = int f_r cos L(y) (G - b)^+ / G dw.
#pragma once

#include <algorithm>

#include "transport/path_vertex.h"
#include "virtual_lights/settings.h"

namespace brisance {

inline constexpr const char* kBounded = "a kind of light with a bound";

// The share min(G, b) / G of the light that reaches a vertex from a point at a squared distance [m^2] and the cosine of
// whose normal is given. `direction`: unit, from the vertex to the point. The bounded term is cos_y / d^2, or also
// holds the vertex's own cosine; vertices in a medium have none.
inline double kept_by_bound(const VirtualLightSettings& s, const LitPoint& vertex, const dvec3& direction,
                            double cosine, double square) {
    double term = cosine;
    if (s.point_bound_of == BoundedTerm::BothCosines && vertex.kind != LitPoint::Kind::Medium)
        term *= std::abs(glm::dot(vertex.normal, direction));
    return term > s.point_bound * square ? s.point_bound * square / term : 1.0;
}

// The share of what a light adds to a vertex, without occlusion and weights of sampling, that
// settings.contribution_bound keeps. It also tames narrow lobes of the vertex and of the light, which no bound on
// geometry does.
inline double kept_of_contribution(const VirtualLightSettings& s, const Rgb& added) {
    if (s.contribution_bound == kUnbounded)
        return 1.0;
    const double light = luminance(added);
    return light > s.contribution_bound ? s.contribution_bound / light : 1.0;
}

}  // namespace brisance
