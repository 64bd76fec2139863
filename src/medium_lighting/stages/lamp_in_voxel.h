// The light of a lamp without extent in a voxel beside it or around it, where a node's place says little of its voxel.
#pragma once

#include "core/vec.h"

namespace brisance {

// Beyond so many edges of voxels the mean over a voxel is the light at its node, to a thousandth.
constexpr float kBesideLamp = 8.0f;

// Means over a voxel, without what weakens light within it.
struct LampInVoxel {
    double fluence = 1.0;  // over that at the voxel's middle
    vec3 along{0.0f};      // of that fluence: what goes into one direction, of length 0 to 1; the rest has none
    double farther = 0.0;  // how much longer the way of that light is than that to the middle [m]
};

// `from_lamp`: to the voxel's middle, not zero, local [m]. A voxel counts as 64 balls: exact but for a twentieth where
// the lamp is at a corner.
LampInVoxel lamp_in_voxel(const mat3& local_from_index, const vec3& from_lamp);

// What reaches such a voxel where `depth` is the optical depth of the farther way, over what reaches its middle. Exact
// in the middle of a ball.
double transmittance_within(double depth);

}  // namespace brisance
