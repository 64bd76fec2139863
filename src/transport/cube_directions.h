// Directions toward points that are spread over a medium's voxels, by solid angle: the points' density is constant in
// each cube of 4^3 voxels. A point is drawn, and only its direction is kept.
#pragma once

#include <vector>

#include "core/rng.h"
#include "tracking/tracking_field.h"

namespace brisance {

class CubeDirections {
public:
    static constexpr int kCube = 4;  // voxels along a side within which the density is constant
    static constexpr int kCubes =
        (BrickLattice::kSize / kCube) * (BrickLattice::kSize / kCube) * (BrickLattice::kSize / kCube);
    // A cube's place in its brick.
    static std::size_t index_of(const ivec3& cube) {
        return static_cast<std::size_t>((cube.x * 2 + cube.y) * 2 + cube.z);
    }

    CubeDirections() = default;
    // `bricks`: those of the field that hold points; `weights`: of the points in each of their cubes, brick after
    // brick, not negative. Empty where their sum is not positive. Keeps a reference to the field.
    CubeDirections(const TrackingField& field, std::vector<std::int32_t> bricks, const std::vector<double>& weights);
    bool empty() const { return cumulative_.empty(); }

    struct Drawn {
        std::size_t brick;
        vec3 in_brick;  // nodes from the brick's first node
        dvec3 position;
        double density;  // [1/m^3]
    };
    Drawn draw(Rng& rng) const;

    // A unit vector from `point` [local, m].
    dvec3 sample(const dvec3& point, Rng& rng) const;

    // The pdf of a ray's direction [1/sr]: the integral of the points' density times distance squared along the whole
    // ray.
    double pdf(const Ray& ray) const;

    std::uint64_t bytes() const {
        return (brick_of_.size() + place_of_.size()) * sizeof(std::int32_t) +
               (cumulative_.size() + density_.size()) * sizeof(double);
    }

private:
    const TrackingField* field_ = nullptr;
    std::vector<std::int32_t> brick_of_;  // of the field, per brick that holds points
    std::vector<std::int32_t> place_of_;  // and back, or -1
    std::vector<double> density_;         // per cube [1/m^3]
    std::vector<double> cumulative_;      // probability, inclusive
    dvec3 origin_{0.0};                   // local position of the lattice's first node [m]
    dmat3 local_from_index_{1.0};
};

// The volume of a cube [m^3].
double cube_volume(const Medium& medium);

}  // namespace brisance
