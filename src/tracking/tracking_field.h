// The medium as a tracker samples it: voxels with all their corners in one brick, and bounds of each brick.
#pragma once

#include <cstdint>
#include <vector>

#include "medium/lattice/voxel_walk.h"

namespace brisance {

// A polynomial of degree three in u, from 0 at a segment's begin to 1 at its end: what a trilinear field is along a
// straight line through one voxel.
struct Cubic {
    double c[4] = {};
    double at(double u) const { return c[0] + u * (c[1] + u * (c[2] + u * c[3])); }
    double integral(double u) const { return u * (c[0] + u * (c[1] / 2 + u * (c[2] / 3 + u * (c[3] / 4)))); }
};

// Fields are copied with one layer of neighbours, 9^3 nodes to a brick of 8^3 voxels; source, emission and albedo only
// where they are needed.
class TrackingField {
public:
    // Keeps a reference to the medium for its transforms.
    explicit TrackingField(const Medium& medium);

    const BrickLattice& bricks() const { return bricks_; }  // of voxels
    LatticeRay enter(const Ray& ray, double end = std::numeric_limits<double>::infinity()) const {
        return lattice_ray(bricks_, index_from_local_, medium_->reference_node, ray, end);
    }

    float minimum(std::size_t brick) const { return minimum_[brick]; }    // of extinction over the brick's voxels
    float majorant(std::size_t brick) const { return majorant_[brick]; }  // [1/m]
    float mean(std::size_t brick) const { return mean_[brick]; }          // of its nodes
    bool burns(std::size_t brick) const { return fire_index_[brick] >= 0; }
    // Whether all voxels of the brick have one extinction, and nothing glows in them.
    bool homogeneous(std::size_t brick) const { return minimum_[brick] == majorant_[brick] && !burns(brick); }
    float mean_cosine() const { return medium_->mean_cosine; }
    const Medium& medium() const { return *medium_; }
    double smoke_volume() const;  // of all bricks that hold some [m^3]
    std::uint64_t bytes() const;

    // At p in nodes from the brick's first node, each coordinate in [0, 8].
    float extinction(std::size_t brick, const vec3& p) const;
    Rgb albedo(std::size_t brick, const vec3& p) const;
    // Where the brick burns; [W/(m^2 sr)] and [W/(m^3 sr)].
    Rgb source(std::size_t brick, const vec3& p) const;
    Rgb emission(std::size_t brick, const vec3& p) const;

    // Extinction along a segment that lies in one voxel, or in a homogeneous brick [1/m]; never negative beyond
    // rounding.
    Cubic extinction_along(const VoxelSegment& segment) const;
    // Whether anything can glow inside the voxel of the segment.
    bool voxel_burns(const VoxelSegment& segment) const;

    bool has_source() const { return !source_.empty(); }
    bool has_emission() const { return !emission_.empty(); }

private:
    void copy_brick(std::size_t brick, const std::vector<std::uint8_t>& glowing);
    void copy_fire(std::size_t brick);

    const Medium* medium_;
    dmat3 index_from_local_{1.0};
    BrickLattice bricks_;
    std::vector<float> extinction_;
    std::vector<Rgb> albedo_;                  // empty: the medium's one albedo
    std::vector<std::int32_t> fire_index_;     // position of a brick's records in source_ and emission_, or -1
    std::vector<Rgb> source_, emission_;       // empty: none
    std::vector<std::uint8_t> burning_voxel_;  // 8^3 to a burning brick
    std::vector<float> minimum_, majorant_, mean_;
};

// Calls visit(part) for the parts of a brick's segment along which the extinction is one cubic, in order, until visit
// returns false: its voxels, or all of it where the brick is homogeneous. Returns false when visit did.
template <class Visit>
bool walk_cubics(const TrackingField& field, const VoxelSegment& in_brick, const Visit& visit) {
    return field.homogeneous(in_brick.brick) ? visit(in_brick) : walk_cubes<1>(in_brick, visit);
}

// The point at distance t of a segment, in nodes from its brick's first node, inside the brick in spite of rounding.
inline vec3 point_in_brick(const VoxelSegment& s, double t) {
    return glm::clamp(vec3(s.origin + s.direction * t), vec3(0.0f), vec3(float(BrickLattice::kSize)));
}

}  // namespace brisance
