// Optical depths along sixteen cones at once: the farther from a cone's apex, the coarser the smoke it looks at.
//
// A sample of an extended light stands for a solid angle of it. Smoke that is narrower than that, seen from the
// receiver, is averaged over the samples anyway. Steps are therefore as long as the cone is wide, and take the level of
// the pyramid whose nodes are as far apart: a cone crosses n nodes in O(log n) steps. What is given up is that the mean
// of the depths stands for that of the transmittances.
#pragma once

#include <array>
#include <vector>

#include "medium/lattice/extinction_pyramid.h"

namespace brisance {

class ConeDepths {
public:
    static constexpr int kCones = 16;

    // `end`: local [m].
    struct Segment {
        vec3 from{0.0f}, to{0.0f};
    };

    // Keeps a reference.
    explicit ConeDepths(const ExtinctionPyramid& pyramid);

    // Computes the depths of the first `count` segments. `widening`: the cones' width per distance from `from`, well
    // below 1; 0 is a ray, in steps of about one node. Segments outside of the medium cost nothing.
    void along(const std::array<Segment, kCones>& segments, int count, float widening,
               std::array<float, kCones>& depth) const;

private:
    std::vector<PackedExtinction> levels_;
    mat3 nodes_from_local_;
    vec3 low_, high_;  // of the medium, in nodes
};

}  // namespace brisance
