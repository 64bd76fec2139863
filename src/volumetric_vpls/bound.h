// The bound of 1 / distance^2 near a point light, and the light that it removes.
#pragma once

#include "tracking/tracking_field.h"
#include "volumetric_vpls/settings.h"

namespace brisance {

// Uses min(1 / w^2, b) instead of 1 / w^2 (Kollig and Keller, Illumination in the Presence of Weak Singularities, MCQMC
// 2004). The fraction 1 - b w^2 of the light that travels the distance w is removed where w < 1 / sqrt(b), and nothing
// at larger distances.
class Bound {
public:
    explicit Bound(double per_metre2) : bound_(per_metre2) {}

    bool limits() const { return bound_ > 0.0; }
    double per_metre2() const { return bound_; }
    double radius() const;                   // within which light is removed [m]; 0: nowhere
    double of(double inverse_square) const;  // [1/m^2]
    double part_left_out(double distance) const;

    // In homogeneous smoke with an albedo of 1: the probability that light arriving at a point from all directions last
    // scattered within radius(), weighted by the fraction removed; that is, the integral over the distance w of
    // extinction * exp(-extinction * w) * part_left_out(w).
    double share_left_out(double extinction) const;

private:
    double bound_;  // [1/m^2]; 0: unbounded
};

// The bound of the settings. Automatic: a ball of radius 1 / sqrt(b) would hold eight of the particles if they were
// distributed uniformly over the smoke. It depends on the medium and the number of particles but not on chance, so that
// compensation stays unbiased.
Bound bound_of(const VolumetricVplSettings& settings, const TrackingField& field);

}  // namespace brisance
