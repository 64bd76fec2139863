// Walking a ray through the cells of a medium and integrating what it sees, segment by segment, exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/cell.h"
#include "medium/cell_walk.h"
#include "render/cell_field.h"

namespace brisance {

// phi1(tau) = (1 - exp(-tau)) / tau, right to rounding for every tau >= 0: by expm1, and its series near zero.
inline float phi1(float tau) {
    return tau < 1e-3f ? 1.0f - tau * (0.5f - tau * (1.0f / 6.0f)) : -std::expm1(-tau) / tau;
}

// Mean optical depth at which light that enters from all along a way of depth tau is met, from its near end: each place
// counts by its transmittance. 1 - tau / (exp(tau) - 1).
inline float mean_depth(float tau) {
    return tau < 1e-3f ? 0.5f * tau : 1.0f - tau / std::expm1(std::min(tau, 80.0f));
}

// Calls visit(segment) for every cell with extinction or emission that the ray crosses in front of its origin, in
// order, up to `end` metres, until visit returns false.
template <class Visit>
void walk_cells(const CellField& field, const Ray& ray, const Visit& visit,
                double end = std::numeric_limits<double>::infinity()) {
    walk_bricks(field.bricks(), lattice_ray(field.bricks(), field.medium(), ray, end),
                [&](const CellSegment& brick) { return walk_cubes<1>(brick, visit); });
}

// What one ray sees.
struct RaySum {
    CellSum cells;
    float depth = 0.0f;            // optical depth of the ray so far, ...
    float similar_depth = 0.0f;    // ... in the medium that scattered light was followed through
    Rgb forward{0.0f};             // optical depth of scattering straight on, where that is followed by itself
    float alpha = 0.0f;            // 1 - exp(-depth), set when the ray is done
    float distance_weight = 0.0f;  // opacity gathered, ...
    float distance_sum = 0.0f;     // ... times the distance along the ray [m]
    Rgb albedo_sum{0.0f};          // ... times albedo (the medium's as luminance)
};

// Beyond this optical depth (transmittance 1e-5) a ray ends; alpha is then 1 to four digits.
constexpr float kOpaqueDepth = 11.5f;

}  // namespace brisance
