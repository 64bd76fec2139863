// Directions toward the fire, by solid angle: a point is sampled in proportion to emission, and only its direction is
// kept, because the whole line is integrated (Simon, Hanika, Zirr, Dachsbacher, Line Integration for Rendering
// Heterogeneous Emissive Volumes, EGSR 2017).
#pragma once

#include "emitters/emitters.h"
#include "transport/cube_directions.h"

namespace brisance {

class FireDirections {
public:
    explicit FireDirections(const TrackingField& field);
    bool empty() const { return points_.empty(); }

    // A unit vector from `point` [local, m].
    dvec3 sample(const dvec3& point, Rng& rng) const { return points_.sample(point, rng); }

    // The pdf of a ray's direction [1/sr]: the integral of the points' density times distance squared along the whole
    // ray.
    double pdf(const Ray& ray) const { return points_.pdf(ray); }

    // A particle that leaves a point of the fire in any direction, and its power over pdf, 4 pi j over the density of
    // points [W]. There must be a fire.
    EmittedParticle emit(Rng& rng) const;
    // Total power of emit(), luminance [W]; evaluated at the centres of voxels, which is enough to distribute
    // particles.
    double power() const { return power_; }

    // Half the diagonal of the box around all emission [m].
    float radius() const { return radius_; }

    std::uint64_t bytes() const { return points_.bytes(); }

private:
    const TrackingField* field_;
    CubeDirections points_;
    float radius_ = 0.0f;
    double power_ = 0.0;
};

}  // namespace brisance
