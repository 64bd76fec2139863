// Samples pairs of points, one on each of two line segments, for integrals that contain their inverse squared distance
// and a phase function at either end (Novak, Nowrouzezahrai, Dachsbacher, Jarosz, Virtual Ray Lights for Rendering
// Scenes with Participating Media, SIGGRAPH 2012). The densities here are derived from that integrand, as the comments
// describe.
#pragma once

#include <optional>

#include "core/rng.h"
#include "core/vec.h"
#include "tracking/segment.h"

namespace brisance {

// Henyey-Greenstein [1/sr] in double precision: `axis` (unit) times `direction` (unit) is the cosine. Keeps its peak
// where |g| is almost 1, as 1 - cos is taken from the difference of the vectors.
double phase_about(const dvec3& axis, const dvec3& direction, double mean_cosine);

// A phase function as it is seen from the apex of an AngularDensity: its cosine is that of `axis` and of the direction
// from the apex to the point.
struct PhaseLobe {
    dvec3 axis{0.0, 0.0, 1.0};
    double mean_cosine = 0.0;
};

// A density [1/m] over a segment for an integrand 1 / distance^2 times up to two phase functions, as seen from a point,
// the apex. The inverse square alone is uniform in the angle under which the apex sees the segment (Kulla and Fajardo,
// Importance Sampling Techniques for Path Tracing in Participating Media, EGSR 2012). Along that angle a phase function
// is a peak of the form (a - b cos)^(-3/2); the density adds one peak (a - b cos)^-1 for each, which can be inverted in
// closed form, and the ratio of both has a variance that stays bounded when |g| goes to 1.
// For beams (beam.h) of a radius above 0 the distance is kept apart from 0, where their kernel is flat, and peaks are
// widened by the angle under which their balls are seen.
class AngularDensity {
public:
    // Lobes of g = 0 are left out. The segment's length must be above zero.
    AngularDensity(const dvec3& apex, const Segment& segment, std::initializer_list<PhaseLobe> lobes,
                   double radius = 0.0);

    double sample(Rng& rng) const;  // distance along the segment [m]
    double pdf(double t) const;     // [1/m]

private:
    struct Lobe {
        double middle = 0.0;  // angle of the peak
        double a_minus_b = 1.0, a_plus_b = 1.0, root = 1.0;
        double first = 0.0, integral = 1.0;  // of 1 / (a - b cos) over the segment
    };
    double angle_of(double t) const;
    double distance_at(double angle_from_start) const;
    static double primitive(const Lobe& lobe, double x);
    static double inverse(const Lobe& lobe, double value);

    double length_;
    double height_;  // distance of the apex from the line
    double before_;  // from the foot of the apex to the segment's start, along the line
    double begin_;   // angle at the start, 0 at the foot
    double angle_;   // from the start to the end
    Lobe lobes_[2];
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

// Light goes from v on `light` to u on `camera` and on against the camera ray's direction; it arrives at v along
// `light`.
class PairDensity {
public:
    // `radius`: of the light [m].
    PairDensity(const Segment& camera, const Segment& light, double mean_cosine, double radius = 0.0);
    // None where one of the segments has no length.
    std::optional<PairSample> sample(Rng& rng) const;
    double pdf(double u, double v) const;

    AngularDensity on_camera(double v) const;
    AngularDensity on_light(double u) const;

private:
    Segment camera_, light_;
    double g_, radius_;
    InverseDistanceDensity marginal_;  // over v
};

}  // namespace brisance
