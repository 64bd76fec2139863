#include "medium/lattice/voxel_walk.h"

namespace brisance {

namespace {

constexpr double kParallel = 1e-200;  // nodes per metre: below it a ray never crosses, and 1 / direction overflows

// Clips [begin, end] to the box [0, size] in nodes.
void clip(LatticeRay& ray, const dvec3& size) {
    for (int a = 0; a < 3; ++a) {
        if (std::abs(ray.direction[a]) < kParallel) {
            ray.direction[a] = 0.0;
            if (ray.origin[a] < 0.0 || ray.origin[a] > size[a])
                ray.end = ray.begin;
            continue;
        }
        const double t0 = -ray.origin[a] / ray.direction[a];
        const double t1 = (size[a] - ray.origin[a]) / ray.direction[a];
        ray.begin = std::max(ray.begin, std::min(t0, t1));
        ray.end = std::min(ray.end, std::max(t0, t1));
    }
}

}  // namespace

LatticeRay lattice_ray(const BrickLattice& bricks, const dmat3& index_from_local, const ivec3& reference_node,
                       const Ray& ray, double end) {
    LatticeRay out;
    if (bricks.empty())
        return out;
    out.origin = index_from_local * ray.origin + dvec3(reference_node - bricks.min_brick() * BrickLattice::kSize);
    out.direction = index_from_local * ray.direction;
    out.end = end;
    clip(out, dvec3(bricks.brick_extent() * BrickLattice::kSize));
    return out;
}

// Bricks are known by their nodes; voxels reach one node up on every axis.
BrickLattice voxel_lattice(const Medium& medium) {
    std::vector<ivec3> bricks;
    for (std::size_t b = 0; b < medium.lattice.brick_count(); ++b) {
        bool lower[3] = {};  // a node of the lowest plane of an axis is not empty
        bool any = false;
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const std::size_t i = b * BrickLattice::kNodes + n;
            if (medium.extinction[i] == 0.0f && (medium.emission.empty() || medium.emission[i] == Rgb(0.0f)))
                continue;
            any = true;
            const ivec3 p = BrickLattice::node_in_brick(n);
            for (int a = 0; a < 3; ++a)
                lower[a] = lower[a] || p[a] == 0;
        }
        for (int k = 0; any && k < 8; ++k)
            if ((!(k & 1) || lower[0]) && (!(k & 2) || lower[1]) && (!(k & 4) || lower[2]))
                bricks.push_back(medium.lattice.brick(b) - ivec3(k & 1, k >> 1 & 1, k >> 2 & 1));
    }
    return BrickLattice(std::move(bricks));
}

LatticeRay lattice_ray(const BrickLattice& bricks, const Medium& medium, const Ray& ray, double end) {
    return lattice_ray(bricks, glm::inverse(dmat3(medium.world_from_index)), medium.reference_node, ray, end);
}

}  // namespace brisance
