// Directions from surfaces toward the smoke's glow: it tells paths where light comes from. Learned once from particles
// of light.
//
// Glow is the power that leaves the smoke, at the places where it was emitted or scattered last: what an eye outside
// of the smoke sees of it, be it fire, or smoke that hides and scatters the light of one. It is summed up for each cube
// of 4^3 voxels. A point drawn in proportion to it gives a direction, whose pdf p_glow is the integral of the points'
// density times distance squared along the whole ray (cube_directions.h).
//
// At a surface one direction is drawn from the mixture
//
//     p(w) = c p_glow(w) + (1 - c) p_BSDF(w),        c in [0.1, 0.8],
//
// and carries BSDF cos / p: combined importance sampling, the one-sample model with the balance heuristic (Veach,
// Robust Monte Carlo Methods for Light Transport Simulation, 1997, section 9.2.4). It finds fire and lit smoke alike
// and stands for a line toward the fire and a direction of the BSDF. The share c is the part that the smoke has in the
// power of the particles that arrive nearby, without what emitters send straight there, which next-event estimation
// finds. It is less where the BSDF has sharp lobes, which find their own light. A guide that is wrong costs noise,
// never truth: p > 0 wherever the BSDF's own pdf is.
//
// Guiding by what particles find: H. W. Jensen, Importance Driven Path Tracing using the Photon Map, EGWR 1995;
// J. Vorba et al., On-line Learning of Parametric Mixture Models for Light Transport Simulation, SIGGRAPH 2014. Here
// the light's origin is learned instead of its directions in every place.
#pragma once

#include <optional>
#include <vector>

#include "transport/cube_directions.h"
#include "transport/direct_light.h"

namespace brisance {

class LightGuide {
public:
    // Keeps a reference to the scene, which must have surfaces and a fire. The same guide for any number of threads.
    explicit LightGuide(const DirectLight& scene);

    // No particle's light left the smoke: there is nothing to aim at.
    bool empty() const { return glow_.empty(); }

    // Toward the glow alone: where it lies, and the density of directions.
    const CubeDirections& glow() const { return glow_; }
    // c, at a local position [m].
    float share(const dvec3& position) const { return shares_[place_of(position)]; }

    // A direction from the mixture at a vertex on a surface, with weight BSDF cos / p, and the vertex's own pdf, by
    // which emitters weight what they find. None: absorbed, or the surface scatters nothing that way.
    std::optional<PathVertex::Sample> sample(const PathVertex& vertex, Rng& rng) const;

    std::uint64_t bytes() const { return glow_.bytes() + shares_.size() * sizeof(float); }

private:
    class Learner;
    // Shares are learned in this many cubes along each side of a box around the scene.
    static constexpr int kPlaces = 16;
    std::size_t place_of(const dvec3& position) const;

    CubeDirections glow_;
    dvec3 low_{0.0};     // of the box [m]
    double size_ = 1.0;  // of a place [m]
    std::vector<float> shares_;
};

}  // namespace brisance
