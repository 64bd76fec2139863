// A segment as it is seen from a point, the apex, and phase functions along the angle under which it is seen.
#pragma once

#include "core/vec.h"
#include "tracking/segment.h"

namespace brisance {

using glm::dvec2;

// Points and lines closer than this fraction of a segment's length are kept apart, in densities only: the integral over
// touching lines is infinite, and no density could be normalised.
constexpr double kClosest = 1e-9;

// Least distance from a beam in densities, relative to its radius.
constexpr double kFlat = 0.5;

// A phase function as it is seen from the apex: its cosine is that of `axis` and of the direction from the apex to the
// point.
struct PhaseLobe {
    dvec3 axis{0.0, 0.0, 1.0};
    double mean_cosine = 0.0;
};

// A phase function along the angle is (a - b cos(angle - middle))^(-3/2), but for a factor; the angle is 0 at the foot
// of the apex. Directions are its cosine and sine. 1 / (a - b cos), which has the same peak, is inverted in closed
// form.
struct AnglePeak {
    double middle = 0.0;   // angle of the peak
    dvec2 axis{1.0, 0.0};  // the same as a direction
    double a_minus_b = 1.0, a_plus_b = 1.0, root = 1.0;
    double first = 0.0, integral = 1.0;  // of 1 / (a - b cos) over the segment

    double base(double angle) const;  // a - b cos
    double base(const dvec2& direction) const;
    double quantile(double xi) const;            // the angle below which that part of 1 / (a - b cos) is
    dvec2 direction_at(double xi) const;         // the same as a direction
    double primitive(double from_middle) const;  // integral of 1 / (a - b cos x) from 0, for any x
    double inverse(double value) const;
};

// For beams of a radius above 0 the distance is kept apart from 0, where their kernel is flat, and peaks are widened by
// the angle under which their balls are seen.
class SegmentAngle {
public:
    // The segment's length must be above zero.
    SegmentAngle(const dvec3& apex, const Segment& segment, double radius);

    double length() const { return length_; }  // of the segment [m]
    double height() const { return height_; }  // distance of the apex from the line [m], never 0
    double begin() const { return begin_; }    // angle at the start, 0 at the foot
    double whole() const { return angle_; }    // from the start to the end

    double at(double t) const;          // angle of a point of the segment, 0 at the foot
    double from_start(double t) const;  // angle between the start and a point
    double from_start(const dvec2& direction) const;
    double distance_at(double angle_from_start) const;
    dvec2 direction_at(double angle_from_start) const;
    double per_metre(double t) const;  // angle per length: height / distance^2

    // Of |g| above 0.
    AnglePeak peak(const PhaseLobe& lobe) const;
    // Whether rounding leaves something of the peak's integral over the segment.
    bool resolves(const AnglePeak& peak) const { return peak.integral > 1e-12 * angle_ / peak.a_plus_b; }

private:
    double length_, height_;
    double before_;  // from the foot of the apex to the segment's start, along the line
    double begin_, angle_;
    double radius_;
    dvec3 direction_, toward_;  // along the segment, and from the apex to its foot
};

}  // namespace brisance
