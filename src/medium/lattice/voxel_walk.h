// Walking a ray through the bricks of a lattice and through their voxels, without gaps or overlaps.
#pragma once

#include <limits>

#include "core/ray.h"
#include "medium/medium.h"

namespace brisance {

// A ray counted in nodes from the first node of a lattice's lowest brick, clipped to the bricks' bounding box.
// Distances along it are metres.
struct LatticeRay {
    dvec3 origin{0.0};
    dvec3 direction{0.0};  // nodes per metre
    double begin = 0.0, end = 0.0;
    bool empty() const { return !(begin < end); }
};

// `index_from_local` is the inverse of the medium's linear part in double precision.
LatticeRay lattice_ray(const BrickLattice& bricks, const dmat3& index_from_local, const ivec3& reference_node,
                       const Ray& ray, double end = std::numeric_limits<double>::infinity());
LatticeRay lattice_ray(const BrickLattice& bricks, const Medium& medium, const Ray& ray,
                       double end = std::numeric_limits<double>::infinity());

// The bricks whose voxels (from a node to the next on every axis) touch a node that absorbs or emits.
BrickLattice voxel_lattice(const Medium& medium);

// Part of a ray inside one brick, or inside one voxel of it.
struct VoxelSegment {
    std::size_t brick;
    double begin, end;  // distances along the ray [m]
    dvec3 origin;       // the ray's origin in nodes from the brick's first node
    dvec3 direction;    // nodes per metre
    ivec3 cube{0};      // in cubes from the brick's first node; 0 for a whole brick
};

// Calls visit(segment) for every brick of the lattice that the ray crosses, in order, until visit returns false. Absent
// bricks cost one step. Returns false when visit did.
template <class Visit>
bool walk_bricks(const BrickLattice& bricks, const LatticeRay& ray, const Visit& visit);

// The same for the cubes of `size` voxels (1, 2, 4) inside one brick's segment.
template <int size, class Visit>
bool walk_cubes(const VoxelSegment& in_brick, const Visit& visit);

}  // namespace brisance

#include "medium/lattice/voxel_walk_inl.h"
