// The extinction field and its coarser averages, packed for fast trilinear sampling.
//
// Level l has nodes at the index points 2^l k: node values of level l + 1 are (1/4, 1/2, 1/4) averages per axis of
// level l's, which keeps the integral.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "medium/lattice/homogeneous_bricks.h"
#include "medium/lattice/occluders.h"
#include "medium/lattice/packed_field.h"
#include "medium/medium.h"

namespace brisance {

class ExtinctionPyramid {
public:
    static constexpr int kMaxLevels = 10;

    // At most `levels` levels, fewer when a level has one brick per axis.
    ExtinctionPyramid(const Medium& medium, int levels);

    int level_count() const { return static_cast<int>(packed_.size()); }
    PackedExtinction view(int level) const { return packed_[level].view(); }
    const BrickLattice& lattice(int level) const { return lattices_[level]; }
    const std::vector<float>& nodes(int level) const { return nodes_[level]; }
    const Medium& medium() const { return *medium_; }
    std::uint64_t bytes() const;

    // Surfaces in the medium that block its light; null (the default): none. Keeps the pointer.
    void set_occluders(const Occluders* occluders) { occluders_ = occluders; }
    const Occluders* occluders() const { return occluders_; }

    // Where rays may take long steps; null (the default): nowhere. Keeps the pointer.
    void set_homogeneous_bricks(const HomogeneousBricks* homogeneous_bricks) {
        homogeneous_bricks_ = homogeneous_bricks;
    }
    const HomogeneousBricks* homogeneous_bricks() const { return homogeneous_bricks_; }

    // Optical depth between two local points [m], sampled on level 0 at steps of about half a voxel. Scalar; for checks
    // and few rays.
    float optical_depth(const vec3& from, const vec3& to) const;
    float extinction_at(const vec3& local) const;

private:
    const Medium* medium_;
    const Occluders* occluders_ = nullptr;
    const HomogeneousBricks* homogeneous_bricks_ = nullptr;
    std::vector<BrickLattice> lattices_;
    std::vector<std::vector<float>> nodes_;
    std::vector<PackedField> packed_;
};

// Averages node values (`channels` interleaved) to the next coarser lattice with weights (1/4, 1/2, 1/4) per axis.
void coarsen(const BrickLattice& fine, std::span<const float> values, int channels, BrickLattice& coarse,
             std::vector<float>& coarse_values);

}  // namespace brisance
