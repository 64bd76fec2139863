// The optical depth between two points of a lattice as a linear combination of the extinction at its nodes.
//
// It is the exact line integral of the trilinear interpolant, which is piecewise cubic along the line: a 2-point Gauss
// rule per piece integrates it without error.
#pragma once

#include <vector>

#include "core/vec.h"

namespace brisance {

// The part of the line from node 0 to the point `p` (index space) that each node has in the mean of the interpolant.
struct LineShare {
    ivec3 node;
    double share;
};
std::vector<LineShare> line_shares(const dvec3& p);

// Of the depth between node 0 and a light that stands near a node, to first order in the light's shift s from there:
//   tau = sum over taps of sigma (length + dot(change, s)).
struct ShiftedTap {
    ivec3 node;
    float length;  // [m]
    vec3 change;   // per metre of shift
};
// `node`: beside which the light stands. Changes are those between half a node to either side.
std::vector<ShiftedTap> shifted_taps(const ivec3& node, const mat3& local_from_index);

}  // namespace brisance
