#include "light_selection/segment_angle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace

double AnglePeak::base(double angle) const {
    const double half = std::sin(0.5 * (angle - middle));
    return a_minus_b + (a_plus_b - a_minus_b) * half * half;
}

double AnglePeak::base(const dvec2& direction) const {
    return a_minus_b + 0.5 * (a_plus_b - a_minus_b) * std::max(0.0, 1.0 - glm::dot(direction, axis));
}

double AnglePeak::quantile(double xi) const {
    return middle + inverse(first + xi * integral);
}

// inverse() is twice the angle of `half`.
dvec2 AnglePeak::direction_at(double xi) const {
    const double y = 0.5 * root * (first + xi * integral);
    const dvec2 half(std::sqrt(a_plus_b) * std::cos(y), std::sqrt(a_minus_b) * std::sin(y));
    const dvec2 x = dvec2(half.x * half.x - half.y * half.y, 2.0 * half.x * half.y) / glm::dot(half, half);
    return {axis.x * x.x - axis.y * x.y, axis.x * x.y + axis.y * x.x};
}

double AnglePeak::primitive(double x) const {
    const double turns = std::round(x / kTurn);
    const double half = 0.5 * (x - kTurn * turns);
    return (2.0 * std::atan2(std::sqrt(a_plus_b) * std::sin(half), std::sqrt(a_minus_b) * std::cos(half)) +
            kTurn * turns) /
           root;
}

double AnglePeak::inverse(double value) const {
    const double y = value * root, turns = std::round(y / kTurn);
    const double half = 0.5 * (y - kTurn * turns);
    return 2.0 * std::atan2(std::sqrt(a_minus_b) * std::sin(half), std::sqrt(a_plus_b) * std::cos(half)) +
           kTurn * turns;
}

SegmentAngle::SegmentAngle(const dvec3& apex, const Segment& segment, double radius)
    : length_(segment.length), radius_(radius), direction_(segment.direction) {
    const dvec3 from = segment.start - apex;
    before_ = glm::dot(from, segment.direction);
    const dvec3 across = from - before_ * segment.direction;
    height_ = glm::length(across);
    toward_ = height_ > 0.0 ? across / height_ : dvec3(0.0);
    height_ = std::max({height_, kClosest * std::max(length_, 1e-290), kFlat * radius});
    begin_ = std::atan2(before_, height_);
    angle_ = from_start(length_);
}

AnglePeak SegmentAngle::peak(const PhaseLobe& lobe) const {
    const double g = std::abs(lobe.mean_cosine);
    const dvec3 axis = lobe.mean_cosine < 0.0 ? -lobe.axis : lobe.axis;
    const double along = glm::dot(axis, direction_), up = glm::dot(axis, toward_);
    // 1 - the length of the projection, computed from the lost part to avoid cancellation.
    const dvec3 lost = axis - along * direction_ - up * toward_;
    const double in_plane = std::hypot(along, up), out2 = glm::dot(lost, lost);
    AnglePeak peak;
    peak.middle = std::atan2(along, up);
    peak.axis = in_plane > 0.0 ? dvec2(up, along) / in_plane : dvec2(1.0, 0.0);
    // a - b cos x is a - b + g x^2 near the peak, which is widened by the angle of the ball.
    double ball = 0.0;
    if (radius_ > 0.0) {
        const double at_peak = before_ + distance_at(std::clamp(peak.middle - begin_, 0.0, angle_));
        ball = std::min(1.0, radius_ / std::hypot(height_, at_peak));
    }
    peak.a_minus_b = (1.0 - g) * (1.0 - g) + 2.0 * g * out2 / (1.0 + in_plane) + g * ball * ball;
    peak.a_plus_b = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 + in_plane) + g * ball * ball;
    peak.root = std::sqrt(peak.a_minus_b * peak.a_plus_b);
    peak.first = peak.primitive(begin_ - peak.middle);
    peak.integral = peak.primitive(begin_ + angle_ - peak.middle) - peak.first;
    return peak;
}

double SegmentAngle::at(double t) const {
    return std::atan2(before_ + t, height_);
}

double SegmentAngle::from_start(double t) const {
    return std::atan2(height_ * t, height_ * height_ + before_ * (before_ + t));
}

double SegmentAngle::from_start(const dvec2& d) const {
    return std::atan2(height_ * d.y - before_ * d.x, height_ * d.x + before_ * d.y);
}

dvec2 SegmentAngle::direction_at(double angle) const {
    return {std::cos(begin_ + angle), std::sin(begin_ + angle)};
}

// tan(begin + angle) without evaluating either tangent.
double SegmentAngle::distance_at(double angle) const {
    const double sine = std::sin(angle), cosine = std::cos(angle);
    const double t = sine * (height_ * height_ + before_ * before_) / (height_ * cosine - before_ * sine);
    return std::clamp(std::isfinite(t) ? t : length_, 0.0, length_);
}

double SegmentAngle::per_metre(double t) const {
    const double along = before_ + t;
    return height_ / (height_ * height_ + along * along);
}

}  // namespace brisance
