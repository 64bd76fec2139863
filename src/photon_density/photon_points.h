// Photons where particles collided in the medium, and the light that they scatter along a ray.
//
// A photon of power P at x stands for scattering around x. Its light is spread over the smoke there, not over the
// space: at a point u it sends out
//   P K(u - x) sigma_s(u) / E(x) * p(direction, toward the viewer),    E(x) = integral of K(y - x) sigma_t(y) over y,
// which in even smoke is P K albedo p. As sigma_s is taken where it is seen, the smoke keeps its detail. As E is a mean
// over all that the kernel K covers, each photon keeps its energy, also at the smoke's skin, and a photon in a thin
// spot beside dense smoke is not magnified by sigma_s(u) / sigma_t(x).
//
// along() blurs over the disc perpendicular to the ray (Jarosz, Zwicker, Jensen, The Beam Radiance Estimate for
// Volumetric Photon Mapping, EG 2008), around() over the ball at points where flights along the ray would collide
// (Jensen and Christensen, Efficient Simulation of Light Transport in Scenes with Participating Media using Photon
// Maps, SIGGRAPH 1998).
#pragma once

#include <vector>

#include "photon_density/box_tree.h"
#include "photon_density/trace_photons.h"
#include "tracking/ray_medium.h"

namespace brisance {

// Means of the extinction, weighted by the kernel: E above [1/m]. By 25 points of the ball, and 13 of the disc
// perpendicular to `axis` (unit); exact where the extinction is a polynomial of degree three.
double extinction_in_ball(const TrackingField& field, const dvec3& centre, double radius);
double extinction_in_disc(const TrackingField& field, const dvec3& centre, const dvec3& axis, double radius);

class PhotonPoints {
public:
    PhotonPoints() = default;
    // Of the flights that collide. Keeps a reference to the field. `discs`: for along(), else for around(); `eye`:
    // local [m], from which most rays come: their discs are known beforehand.
    PhotonPoints(const TrackingField& field, const std::vector<PhotonFlight>& flights, double radius, bool discs,
                 const dvec3& eye);

    // Light scattered along the ray toward its start [W/(m^2 sr)].
    Rgb along(const RayMedium& seen, double mean_cosine) const;
    Rgb around(const RayMedium& seen, double mean_cosine, Rng& rng) const;

    std::size_t size() const { return photons_.size(); }
    std::uint64_t bytes() const { return photons_.size() * sizeof(Photon) + tree_.bytes(); }

private:
    struct Photon {
        vec3 position;   // local [m]
        vec3 direction;  // unit, of travel
        Rgb power;       // P [W]
        float length;    // 1 / E, of the disc toward the eye or of the ball [m]
    };
    Rgb around_point(const dvec3& point, const dvec3& toward_viewer, double mean_cosine) const;

    double length_across(const Photon& photon, const dvec3& axis) const;

    const TrackingField* field_ = nullptr;
    double radius_ = 0.0;
    dvec3 eye_{0.0};
    BoxTree tree_;
    std::vector<Photon> photons_;  // in the tree's order
};

}  // namespace brisance
