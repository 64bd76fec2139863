// The bound of 1 / distance^2 near a point light, and what it takes away.
#pragma once

#include "tracking/tracking_field.h"
#include "volumetric_vpls/settings.h"

namespace brisance {

// min(1 / w^2, b) in place of 1 / w^2 (Kollig and Keller, Illumination in the Presence of Weak Singularities, MCQMC
// 2004). Of what travels the distance w, the part 1 - b w^2 is left out where w < 1 / sqrt(b); nothing farther away.
class Bound {
public:
    explicit Bound(double per_metre2) : bound_(per_metre2) {}

    bool limits() const { return bound_ > 0.0; }
    double per_metre2() const { return bound_; }
    double radius() const;                   // within which light is left out [m]; 0: nowhere
    double of(double inverse_square) const;  // [1/m^2]
    double part_left_out(double distance) const;

    // In smoke that is alike everywhere, of an albedo of 1: the chance that light from all around a place last
    // scattered within radius(), times the part left out there; that is, the integral over the distance w of
    // extinction * exp(-extinction * w) * part_left_out(w).
    double share_left_out(double extinction) const;

private:
    double bound_;  // [1/m^2]; 0: unbounded
};

// What the settings ask for. Automatic: a ball of radius 1 / sqrt(b) would hold eight of the particles, were they
// spread evenly over the smoke. It depends on the medium and their number but not on chance, so that compensation stays
// unbiased.
Bound bound_of(const VolumetricVplSettings& settings, const TrackingField& field);

}  // namespace brisance
