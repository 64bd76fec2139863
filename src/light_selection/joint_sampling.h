// Samples pairs of points, one on each of two line segments, for integrals that contain their inverse squared distance
// and a phase function at either end (Novak, Nowrouzezahrai, Dachsbacher, Jarosz, Virtual Ray Lights for Rendering
// Scenes with Participating Media, SIGGRAPH 2012). The densities here are derived from that integrand, as the comments
// describe.
#pragma once

#include <initializer_list>
#include <optional>

#include "core/rng.h"
#include "core/vec.h"
#include "light_selection/segment_angle.h"

namespace brisance {

// Henyey-Greenstein [1/sr] in double precision: `axis` (unit) times `direction` (unit) is the cosine. Keeps its peak
// where |g| is almost 1, as 1 - cos is taken from the difference of the vectors.
double phase_about(const dvec3& axis, const dvec3& direction, double mean_cosine);

// A density [1/m] over a segment for an integrand 1 / distance^2 times up to two phase functions, as seen from a point,
// the apex. The inverse square alone is uniform in the angle under which the apex sees the segment (Kulla and Fajardo,
// Importance Sampling Techniques for Path Tracing in Participating Media, EGSR 2012). Along that angle a phase function
// is a peak of the form (a - b cos)^(-3/2); the density adds one peak (a - b cos)^-1 for each, which can be inverted in
// closed form, and the ratio of both has a variance that stays bounded when |g| goes to 1.
class AngularDensity {
public:
    // Lobes of g = 0 are left out. The segment's length must be above zero. `radius`: of beams [m], see SegmentAngle.
    AngularDensity(const dvec3& apex, const Segment& segment, std::initializer_list<PhaseLobe> lobes,
                   double radius = 0.0);

    double sample(Rng& rng) const;  // distance along the segment [m]
    double pdf(double t) const;     // [1/m]

private:
    SegmentAngle seen_;
    AnglePeak peaks_[2];
    int count_ = 0;
};

// A density [1/m] over `ray` for the integral of 1 / distance^2 over the whole line of `other`: proportional to the
// inverse distance from that line. Uniform where the two are so close to parallel, or so far apart, that this is
// constant to a thousandth. Flat, for beams, within half their radius: the kernel's integral along a line through the
// middle is about 2 pi over the radius.
class InverseDistanceDensity {
public:
    InverseDistanceDensity(const Segment& ray, const Segment& other, double radius = 0.0);
    double quantile(double xi) const;  // inverse of the distribution function [m]
    double cumulative(double t) const;
    double sample(Rng& rng) const { return quantile(rng.next_double()); }
    double pdf(double t) const;

private:
    double length_;
    bool uniform_ = true;
    double sine_ = 0.0, closest_ = 0.0, height_ = 0.0;  // of the angle; where on the ray; how far there
    double begin_ = 0.0, range_ = 0.0;                  // of asinh(sine * (t - closest) / height)
};

// u on the camera's ray, v on the other; the joint density [1/m^2].
struct PairSample {
    double u = 0.0, v = 0.0, pdf = 0.0;
};

// How the factors of a pair's density are made: `OnLight` over v, and `Angular` over either segment as seen from a
// point of the other.
struct ClosedFormSampling {
    using OnLight = InverseDistanceDensity;
    using Angular = AngularDensity;
    static OnLight on_light(const Segment& camera, const Segment& light, double mean_cosine, double radius);
};

// Light goes from v on `light` to u on `camera` and on against the camera ray's direction; it arrives at v along
// `light`.
template <class Sampling>
class PairDensityOf {
public:
    using Angular = typename Sampling::Angular;

    // `radius`: of the light [m].
    PairDensityOf(const Segment& camera, const Segment& light, double mean_cosine, double radius = 0.0)
        : camera_(camera),
          light_(light),
          g_(mean_cosine),
          radius_(radius),
          marginal_(Sampling::on_light(camera, light, mean_cosine, radius)) {}

    bool empty() const { return !(camera_.length > 0.0) || !(light_.length > 0.0); }

    // None where one of the segments has no length.
    std::optional<PairSample> sample(Rng& rng) const {
        if (empty())
            return std::nullopt;
        PairSample s;
        s.v = marginal_.sample(rng);
        const Angular on_camera_ray = on_camera(s.v);
        s.u = on_camera_ray.sample(rng);
        s.pdf = marginal_.pdf(s.v) * on_camera_ray.pdf(s.u);
        return s;
    }
    double pdf(double u, double v) const { return marginal_.pdf(v) * on_camera(v).pdf(u); }

    Angular on_camera(double v) const {
        return {light_.at(v), camera_, {{light_.direction, g_}, {-camera_.direction, g_}}, radius_};
    }
    // Seen from u, light travels against the direction from the apex.
    Angular on_light(double u) const {
        return {camera_.at(u), light_, {{-light_.direction, g_}, {camera_.direction, g_}}, radius_};
    }

private:
    Segment camera_, light_;
    double g_, radius_;
    typename Sampling::OnLight marginal_;  // over v
};

using PairDensity = PairDensityOf<ClosedFormSampling>;

}  // namespace brisance
