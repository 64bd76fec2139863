// The track-length estimator at a medium's nodes (Spanier, Two Pairs of Families of Estimators for Transport Problems,
// SIAM J. Appl. Math. 14(4), 1966). The fluence at a node is the track length times transmitted power over the volume
// around the node.
#pragma once

#include "core/nearest_whole.h"
#include "medium/attenuation.h"
#include "medium/lattice/voxel_walk.h"

namespace brisance {

class TrackLengths {
public:
    // Keeps a reference.
    explicit TrackLengths(const Medium& medium)
        : medium_(medium),
          voxels_(voxel_lattice(medium)),
          index_from_local_(glm::inverse(dmat3(medium.local_from_index))) {}

    // Cuts the ray up to `end` [m] into segments, each of which counts for its nearest node. Calls visit(node, length)
    // with the node's index and the segment's length times the transmittance [m], until the light is almost extinct.
    template <class Visit>
    void along(const Ray& ray, double end, const Visit& visit) const;

    // The share, from 0 to 1, of the cube around a node that lies in voxels whose track lengths count.
    float part_in_voxels(const ivec3& node) const {
        int voxels = 0;
        for (int k = 0; k < 8; ++k)
            voxels += voxels_.find_node(node - ivec3(k >> 2, k >> 1 & 1, k & 1)) >= 0;
        return float(voxels) / 8.0f;
    }

private:
    static constexpr int kParts = 2;  // of a segment through a voxel

    const Medium& medium_;
    BrickLattice voxels_;
    dmat3 index_from_local_;
};

template <class Visit>
void TrackLengths::along(const Ray& ray, double end, const Visit& visit) const {
    float depth = 0.0f;
    const auto in_voxel = [&](const VoxelSegment& s) {
        const double length = (s.end - s.begin) / kParts;
        for (int part = 0; part < kParts; ++part) {
            const dvec3 position = s.origin + s.direction * (s.begin + (part + 0.5) * length);
            const ivec3 nearest(nearest_whole(position.x), nearest_whole(position.y), nearest_whole(position.z));
            const std::int64_t node = medium_.lattice.find_node(voxels_.first_node(s.brick) + nearest);
            if (node < 0)
                continue;
            const float tau = medium_.extinction[node] * float(length);
            visit(node, std::exp(-depth) * float(length) * phi1(tau));
            depth += tau;
        }
        return depth < kOpaqueDepth;
    };
    walk_bricks(voxels_, lattice_ray(voxels_, index_from_local_, medium_.reference_node, ray, end),
                [&](const VoxelSegment& brick) { return walk_cubes<1>(brick, in_voxel); });
}

}  // namespace brisance
