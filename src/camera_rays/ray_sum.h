// The light along one ray, and the walk through the voxels that it crosses.
#pragma once

#include <limits>

#include "camera_rays/source_field.h"
#include "core/cell.h"
#include "medium/attenuation.h"
#include "medium/lattice/voxel_walk.h"

namespace brisance {

// Calls visit(segment) for every voxel with extinction or emission that the ray crosses in front of its origin, in
// order, up to `end` metres, until visit returns false.
template <class Visit>
void walk_voxels(const SourceField& field, const Ray& ray, const Visit& visit,
                 double end = std::numeric_limits<double>::infinity()) {
    walk_bricks(field.bricks(), lattice_ray(field.bricks(), field.medium(), ray, end),
                [&](const VoxelSegment& brick) { return walk_cubes<1>(brick, visit); });
}

// A point of a segment, for samples of the field: in nodes from the brick's first node.
inline vec3 position_in_brick(const VoxelSegment& s, double t) {
    return glm::clamp(vec3(s.origin + s.direction * t), vec3(0.0f), vec3(float(BrickLattice::kSize)));
}

// The light along one ray.
struct RaySum {
    CellSum cells;
    float depth = 0.0f;            // optical depth of the ray so far, ...
    float similar_depth = 0.0f;    // ... in the medium through which scattered light was traced
    Rgb forward{0.0f};             // optical depth of undeflected scattering, where it is traced separately
    float alpha = 0.0f;            // 1 - exp(-depth), set when the ray is done
    float through = 0.0f;          // exp(-depth), the same
    float distance_weight = 0.0f;  // opacity gathered, ...
    float distance_sum = 0.0f;     // ... times the distance along the ray [m]
    Rgb albedo_sum{0.0f};          // ... times albedo (the medium's as luminance)
    // Single scattering of MV and MA, where those of `cells` hold more (PictureSettings::once).
    Rgb once_from_fire{0.0f}, once_from_emitters{0.0f};
};

}  // namespace brisance
