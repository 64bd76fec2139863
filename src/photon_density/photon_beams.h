// Photon beams: the flights of particles through the medium, and the light that they scatter along a ray (Jarosz,
// Nowrouzezahrai, Sadeghi, Jensen, A Comprehensive Theory of Volumetric Radiance Estimation using Photon Points and
// Beams, TOG 2011).
//
// Beam and ray come closest at v on the beam and u on the ray, at the distance h and the angle theta:
//   P K(h) / sin(theta) sigma_s(u) T(0, u) p(theta)  [W/(m^2 sr)],
// a blur over one dimension, across both. Beams are short: they end where their particle collided, and carry its power
// up to there. What reaches v is so estimated without transmittance, in any smoke. As sigma_s and T are those of the
// ray, smoke keeps its detail, and beams that pass beside the smoke light its skin.
//
// 1 / sin(theta) has a finite variance: that a beam is met at all has a probability like sin(theta), and so have the
// directions around the ray's own.
#pragma once

#include <vector>

#include "photon_density/box_tree.h"
#include "photon_density/trace_photons.h"
#include "tracking/ray_medium.h"

namespace brisance {

class PhotonBeams {
public:
    PhotonBeams() = default;
    // Flights are cut into pieces of at most `longest` [m], whose boxes are tight.
    PhotonBeams(const std::vector<PhotonFlight>& flights, double radius, double longest);

    // Light scattered along the ray toward its start [W/(m^2 sr)].
    Rgb along(const RayMedium& seen, double mean_cosine) const;

    std::size_t size() const { return beams_.size(); }
    std::uint64_t bytes() const { return beams_.size() * sizeof(PhotonFlight) + tree_.bytes(); }

private:
    double radius_ = 0.0;
    BoxTree tree_;
    std::vector<PhotonFlight> beams_;  // in the tree's order
};

}  // namespace brisance
