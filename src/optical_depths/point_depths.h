// Computes the optical depths from one point to sixteen others at once.
#pragma once

#include "medium/lattice/extinction_pyramid.h"

namespace brisance {

class PointDepths {
public:
    static constexpr int kRays = 16;

    // Samples level `level` of the pyramid (the last one where it has fewer) at steps of about one of its nodes. Keeps
    // a reference.
    PointDepths(const ExtinctionPyramid& pyramid, int level);

    // Computes the depths from `from` to to[0 ... 15], local [m]. Segments outside of the medium cost nothing. Where
    // neighbouring ones are all opaque, depths are at least kOpaque, but may be too small.
    static constexpr float kOpaque = 30.0f;
    void between(const vec3& from, const vec3* to, float* depth) const;

private:
    PackedExtinction extinction_;
    mat3 nodes_from_local_;
    vec3 low_, high_;  // of the medium, in nodes of the level
    float metres_per_node_;
};

}  // namespace brisance
