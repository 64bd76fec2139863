// Densities of joint_sampling.h for anisotropic media from tables of the integrand itself: 1 / distance^2 times both
// phase functions, linear between knots (after Novak, Nowrouzezahrai, Dachsbacher, Jarosz, Virtual Ray Lights for
// Rendering Scenes with Participating Media, SIGGRAPH 2012). Tables are made anew for each pair of segments. The
// closed form adds the peaks of two phase functions where the integrand has their product; tables have the product,
// and the marginal knows where the camera's ray ends.
// Where knots lie, and how many there are, is chosen here.
#pragma once

#include <array>
#include <initializer_list>
#include <span>

#include "light_selection/joint_sampling.h"
#include "light_selection/segment_angle.h"

namespace brisance {

// A density that is linear between at most kMost knots.
class LinearTable {
public:
    static constexpr int kMost = 24;

    // Knots are added in rising order, two at least, with a value above zero each.
    void add(double knot, double value);
    // Into an interval: their numbers rise with the knots.
    void insert(int interval, double knot, double value);
    // The interval over which it varies most, times its width.
    int roughest() const;
    double middle(int interval) const { return 0.5 * (knots_[interval] + knots_[interval + 1]); }
    void add_floor(double value);
    void finish();  // before any of the following

    double integral() const { return sums_[count_ - 1]; }
    double quantile(double xi) const;
    double pdf(double x) const;

private:
    std::array<double, kMost> knots_, values_, sums_;  // sums: integral up to the knot
    int count_ = 0;
};

// The product of up to two phase functions, but for constant factors, over a segment as seen from a point.
class PhaseProduct {
public:
    // Lobes of g = 0 are left out.
    PhaseProduct(const dvec3& apex, const Segment& segment, std::initializer_list<PhaseLobe> lobes, double radius);

    const SegmentAngle& seen() const { return seen_; }
    std::span<const AnglePeak> peaks() const { return {peaks_, std::size_t(count_)}; }
    double at(const dvec2& direction) const;
    // Of the product times 1 / distance^2 over the segment [1/m], by quadrature.
    double integral() const;

private:
    SegmentAngle seen_;
    AnglePeak peaks_[2];
    int count_ = 0;
};

// A density [1/m] over a segment as seen from the apex, like AngularDensity: uniform in the angle times a table of the
// product of the phase functions. Knots lie evenly over the angle, and at quantiles of 1 / (a - b cos) around each
// peak.
class TabulatedAngle {
public:
    // The segment's length must be above zero. `radius`: of beams [m], see SegmentAngle.
    TabulatedAngle(const dvec3& apex, const Segment& segment, std::initializer_list<PhaseLobe> lobes,
                   double radius = 0.0)
        : TabulatedAngle(PhaseProduct(apex, segment, lobes, radius)) {}

    double sample(Rng& rng) const;  // distance along the segment [m]
    double pdf(double t) const;     // [1/m]

private:
    explicit TabulatedAngle(const PhaseProduct& product);

    SegmentAngle seen_;
    LinearTable table_;  // over the angle from the segment's start
};

// A density [1/m] over the light: the inverse distance from the camera's line times a table of what the integral over
// the camera's ray, with both phase functions, is relative to that. Intervals in which the table varies most are halved
// again and again.
class TabulatedOnLight {
public:
    TabulatedOnLight(const Segment& camera, const Segment& light, double mean_cosine, double radius);

    double sample(Rng& rng) const { return inverse_distance_.quantile(table_.quantile(rng.next_double())); }
    double pdf(double v) const { return inverse_distance_.pdf(v) * table_.pdf(inverse_distance_.cumulative(v)); }

private:
    InverseDistanceDensity inverse_distance_;
    LinearTable table_;  // over the distribution function of inverse_distance_
};

struct TabulatedSampling {
    using OnLight = TabulatedOnLight;
    using Angular = TabulatedAngle;
    static OnLight on_light(const Segment& camera, const Segment& light, double mean_cosine, double radius) {
        return {camera, light, mean_cosine, radius};
    }
};

using TabulatedPairs = PairDensityOf<TabulatedSampling>;

}  // namespace brisance
