// Voxels that the surface at the end of a ray cuts.
//
// Light is known at nodes, and nodes behind a surface have that of its other side: below a floor there may be darkness,
// or more fire than above. A ray is in front of the surface that ends it until it ends there, and so is all that it
// shows. For such a ray each node behind the plane of that surface takes over the scattered light of its neighbours in
// front. Extinction and emission are those of the medium, which surfaces do not change. Surfaces that a ray passes
// closer than a voxel without meeting them are not looked for.
#pragma once

#include <limits>

#include "camera_rays/source_field.h"
#include "medium/lattice/voxel_walk.h"

namespace brisance {

// Of a ray: the distance of the surface that ends it [m], and that surface's unit normal toward the ray's origin; zero:
// unknown, and nothing is replaced.
struct RayEnd {
    double distance = std::numeric_limits<double>::infinity();
    dvec3 normal{0.0};
};

// The records of a brick. `outside`: null where the field has none.
struct BrickRecords {
    const SourceRecord* own;
    const SurroundingsRecord* outside;
};
inline BrickRecords records_of(const SourceField& field, std::size_t brick) {
    return {field.own_records(brick), field.has_outside() ? field.outside_records(brick) : nullptr};
}

class OneSidedVoxels {
public:
    // Keeps a reference to the field.
    OneSidedVoxels(const SourceField& field, const RayEnd& end);

    // Whether some voxel of a brick may have a node behind the surface, and whether this voxel has.
    bool may_cut(const VoxelSegment& brick) const {
        return some_ && side_of(brick, ivec3(0)) + BrickLattice::kSize * most_behind_ <= 0.0;
    }
    bool cuts(const VoxelSegment& voxel) const { return some_ && side_of(voxel, voxel.cube) + most_behind_ <= 0.0; }
    // Its brick's records, of which only those at the nodes of the voxel and of its neighbours are made: positions are
    // rounded. They belong to the thread, and hold until the next call.
    BrickRecords in_front(const VoxelSegment& voxel) const;

private:
    // Of a node, in nodes from the brick's first: its distance from the surface [m], above 0 in front.
    double side_of(const VoxelSegment& voxel, const ivec3& node) const {
        return glm::dot(normal_, dvec3(node) - (voxel.origin + distance_ * voxel.direction)) + moved_;
    }

    const SourceField& field_;
    double distance_;
    dvec3 normal_;        // metres per node
    double moved_;        // nodes count as that much closer to the front [m] (kBesidePlanes)
    double most_behind_;  // how far some node of a voxel is from its first, at most 0 [m]
    bool some_;
};

}  // namespace brisance
