// A vertex of a path: in the medium, where the phase function scatters, or on a surface, where the BSDF does.
#pragma once

#include <optional>

#include "core/rng.h"
#include "emitters/light_tree.h"
#include "geometry/surface_point.h"
#include "surfaces/bsdf_bound.h"

namespace brisance {

// Upper bounds of PathVertex::at() over cones of directions: made once for a vertex, asked for many groups of lights.
class ScatteringBound {
public:
    // Largest channel [1/sr]. `axis`: unit, from the vertex; `cos_around`: of the cone's half angle, -1: everywhere.
    // `most_cosine`: on surfaces, of the directions that count (BsdfBound).
    double over(const dvec3& axis, double cos_around, double most_cosine = 1.0) const;

private:
    friend class PathVertex;
    std::optional<BsdfBound> bsdf_;
    dvec3 arriving_{0.0};
    float mean_cosine_ = 0.0f;
};

class PathVertex {
public:
    // In the medium. `arriving`: unit, the direction in which the path reaches the vertex.
    PathVertex(const dvec3& position, const dvec3& arriving, float mean_cosine);
    PathVertex(const SurfacePoint& point, const dvec3& arriving);
    // With a BSDF that may hold some of the material's lobes only.
    PathVertex(const SurfacePoint& point, const Bsdf& bsdf, const dvec3& arriving);

    bool on_surface() const { return surface_.has_value(); }
    const dvec3& position() const { return lit_.position; }
    const LitPoint& lit() const { return lit_; }
    const dvec3& arriving() const { return arriving_; }
    // All lobes are deltas: only sample() finds directions.
    bool only_delta() const { return only_delta_; }

    // A ray that starts here, clear of the surface.
    Ray leaving(const dvec3& direction) const;
    // The same toward a point, and the distance to it.
    Ray toward(const dvec3& target, double& distance) const;

    // Phase function, or BSDF times cosine, and the pdf of sample() [1/sr]; without delta lobes. `transport`: as there.
    struct Value {
        Rgb value{0.0f};
        double pdf = 0.0;
    };
    Value at(const dvec3& wi, Transport transport = Transport::Radiance) const;
    // Refers to the vertex.
    ScatteringBound bound() const;

    struct Sample {
        dvec3 wi;
        Rgb weight{1.0f};  // value over pdf
        double pdf = 0.0;
        bool delta = false;
    };
    // None: the path is absorbed. Importance is for particles of light, which carry power along `arriving` and on: the
    // adjoint BSDF, with the factor for shading normals (Veach, Robust Monte Carlo Methods, 1997, sections 5.2, 5.3).
    std::optional<Sample> sample(Rng& rng, Transport transport = Transport::Radiance) const;
    // The same of a surface, by three numbers in [0, 1).
    std::optional<Sample> sample_lobes(const dvec3& numbers, Transport transport = Transport::Radiance) const;

private:
    std::optional<float> shading_normal_factor(const dvec3& wi) const;

    LitPoint lit_;
    dvec3 arriving_;
    float mean_cosine_ = 0.0f;
    bool only_delta_ = false;
    // One optional for both, so that vertices in the medium construct neither.
    struct OnSurface {
        SurfacePoint point;
        Bsdf bsdf;
    };
    std::optional<OnSurface> surface_;
};

// A direction sampled from the Henyey-Greenstein phase function about `forward`.
dvec3 sample_henyey_greenstein(const dvec3& forward, float mean_cosine, Rng& rng);

}  // namespace brisance
