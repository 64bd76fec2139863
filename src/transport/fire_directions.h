// Directions toward the fire, by solid angle: a point is sampled in proportion to emission, and only its direction is
// kept, because the whole line is integrated (Simon, Hanika, Zirr, Dachsbacher, Line Integration for Rendering
// Heterogeneous Emissive Volumes, EGSR 2017).
#pragma once

#include <vector>

#include "core/rng.h"
#include "emitters/emitters.h"
#include "tracking/tracking_field.h"

namespace brisance {

class FireDirections {
public:
    explicit FireDirections(const TrackingField& field);
    bool empty() const { return cumulative_.empty(); }

    // A unit vector from `point` [local, m].
    dvec3 sample(const dvec3& point, Rng& rng) const;

    // The pdf of a ray's direction [1/sr]: the integral of the points' density times distance squared along the whole
    // ray.
    double pdf(const Ray& ray) const;

    // A particle that leaves a point of the fire in any direction, and its power over pdf, 4 pi j over the density of
    // points [W]. There must be a fire.
    EmittedParticle emit(Rng& rng) const;
    // Total power of emit(), luminance [W]; evaluated at the centres of voxels, which is enough to distribute
    // particles.
    double power() const { return power_; }

    // Half the diagonal of the box around all emission [m].
    float radius() const { return radius_; }

    std::uint64_t bytes() const { return (cumulative_.size() + density_.size()) * sizeof(double); }

private:
    static constexpr int kCube = 4;  // voxels along a side within which the density is constant
    static constexpr int kCubes =
        (BrickLattice::kSize / kCube) * (BrickLattice::kSize / kCube) * (BrickLattice::kSize / kCube);

    struct Drawn {
        std::size_t brick;
        vec3 in_brick;  // nodes from the brick's first node
        dvec3 position;
        double density;  // [1/m^3]
    };
    Drawn draw(Rng& rng) const;

    const TrackingField* field_;
    std::vector<std::int32_t> brick_of_;    // of the field, per burning brick
    std::vector<std::int32_t> burning_of_;  // and back, or -1
    std::vector<double> density_;           // per cube [1/m^3]
    std::vector<double> cumulative_;        // probability, inclusive
    float radius_ = 0.0f;
    double power_ = 0.0;
    dvec3 origin_{0.0};  // local position of the lattice's first node [m]
    dmat3 local_from_index_{1.0};
};

}  // namespace brisance
