#include "light_selection/joint_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// Points and lines closer than this fraction of a segment's length are kept apart, in the density only: the integral
// over touching lines is infinite, and no density could be normalised.
constexpr double kClosest = 1e-9;

// Below this range of asinh the inverse distance varies by less than a thousandth over the ray, and the difference of
// two asinh would lose its digits.
constexpr double kUniformRange = 1e-3;

// Least distance from a beam in the density, relative to its radius.
constexpr double kFlat = 0.5;

}  // namespace

double phase_about(const dvec3& axis, const dvec3& direction, double g) {
    const dvec3 apart = g < 0.0 ? axis + direction : axis - direction;
    const double a = std::abs(g), one_minus_cosine = 0.5 * glm::dot(apart, apart);
    const double d = (1.0 - a) * (1.0 - a) + 2.0 * a * one_minus_cosine;
    return (1.0 - a) * (1.0 + a) / (2.0 * kTwoPi * d * std::sqrt(d));
}

AngularDensity::AngularDensity(const dvec3& apex, const Segment& segment, std::initializer_list<PhaseLobe> lobes,
                               double radius)
    : length_(segment.length) {
    const dvec3 from = segment.start - apex;
    before_ = glm::dot(from, segment.direction);
    const dvec3 across = from - before_ * segment.direction;
    height_ = glm::length(across);
    const dvec3 toward = height_ > 0.0 ? across / height_ : dvec3(0.0);
    height_ = std::max({height_, kClosest * std::max(length_, 1e-290), kFlat * radius});
    begin_ = std::atan2(before_, height_);
    angle_ = std::atan2(height_ * length_, height_ * height_ + before_ * (before_ + length_));
    for (const PhaseLobe& l : lobes) {
        const double g = std::abs(l.mean_cosine);
        if (!(g > 0.0))
            continue;
        const dvec3 axis = l.mean_cosine < 0.0 ? -l.axis : l.axis;
        const double along = glm::dot(axis, segment.direction), up = glm::dot(axis, toward);
        // 1 - the length of the projection, computed from the lost part to avoid cancellation.
        const dvec3 lost = axis - along * segment.direction - up * toward;
        const double in_plane = std::hypot(along, up), out2 = glm::dot(lost, lost);
        Lobe& lobe = lobes_[count_++];
        lobe.middle = std::atan2(along, up);
        // a - b cos x is a - b + g x^2 near the peak, which is widened by the angle of the ball.
        const double at_peak = before_ + distance_at(std::clamp(lobe.middle - begin_, 0.0, angle_));
        const double ball = std::min(1.0, radius / std::hypot(height_, at_peak));
        lobe.a_minus_b = (1.0 - g) * (1.0 - g) + 2.0 * g * out2 / (1.0 + in_plane) + g * ball * ball;
        lobe.a_plus_b = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 + in_plane) + g * ball * ball;
        lobe.root = std::sqrt(lobe.a_minus_b * lobe.a_plus_b);
        lobe.first = primitive(lobe, begin_ - lobe.middle);
        lobe.integral = primitive(lobe, begin_ + angle_ - lobe.middle) - lobe.first;
        if (!(lobe.integral > 1e-12 * angle_ / lobe.a_plus_b))
            --count_;
    }
}

// The integral of 1 / (a - b cos x) from 0, for any x.
double AngularDensity::primitive(const Lobe& l, double x) {
    const double turns = std::round(x / kTwoPi);
    const double half = 0.5 * (x - kTwoPi * turns);
    return (2.0 * std::atan2(std::sqrt(l.a_plus_b) * std::sin(half), std::sqrt(l.a_minus_b) * std::cos(half)) +
            kTwoPi * turns) /
           l.root;
}

double AngularDensity::inverse(const Lobe& l, double value) {
    const double y = value * l.root, turns = std::round(y / kTwoPi);
    const double half = 0.5 * (y - kTwoPi * turns);
    return 2.0 * std::atan2(std::sqrt(l.a_minus_b) * std::sin(half), std::sqrt(l.a_plus_b) * std::cos(half)) +
           kTwoPi * turns;
}

double AngularDensity::angle_of(double t) const {
    return std::atan2(before_ + t, height_);
}

// tan(begin + angle) without evaluating either tangent.
double AngularDensity::distance_at(double angle) const {
    const double sine = std::sin(angle), cosine = std::cos(angle);
    const double t = sine * (height_ * height_ + before_ * before_) / (height_ * cosine - before_ * sine);
    return std::clamp(std::isfinite(t) ? t : length_, 0.0, length_);
}

double AngularDensity::sample(Rng& rng) const {
    const int choice = std::min(count_, static_cast<int>(rng.next_double() * (count_ + 1)));
    const double xi = rng.next_double();
    if (choice == 0)
        return distance_at(xi * angle_);
    const Lobe& lobe = lobes_[choice - 1];
    const double angle = lobe.middle + inverse(lobe, lobe.first + xi * lobe.integral) - begin_;
    return distance_at(std::clamp(angle, 0.0, angle_));
}

double AngularDensity::pdf(double t) const {
    const double along = before_ + t;
    double per_angle = 1.0 / angle_;
    for (int i = 0; i < count_; ++i) {
        const Lobe& l = lobes_[i];
        const double half = std::sin(0.5 * (angle_of(t) - l.middle));
        per_angle += 1.0 / (l.integral * (l.a_minus_b + (l.a_plus_b - l.a_minus_b) * half * half));
    }
    return per_angle / (count_ + 1) * height_ / (height_ * height_ + along * along);
}

InverseDistanceDensity::InverseDistanceDensity(const Segment& ray, const Segment& other, double radius)
    : length_(ray.length) {
    const dvec3 from = ray.start - other.start;
    const dvec3 across = from - glm::dot(from, other.direction) * other.direction;
    const dvec3 turn = ray.direction - glm::dot(ray.direction, other.direction) * other.direction;
    sine_ = glm::length(turn);
    if (!(sine_ > 0.0) || !(length_ > 0.0))
        return;
    closest_ = -glm::dot(across, turn) / (sine_ * sine_);
    height_ = std::max({glm::length(across + closest_ * turn), kClosest * sine_ * length_, kFlat * radius});
    begin_ = std::asinh(-closest_ * sine_ / height_);
    range_ = std::asinh((length_ - closest_) * sine_ / height_) - begin_;
    uniform_ = !(range_ >= kUniformRange);
}

double InverseDistanceDensity::quantile(double xi) const {
    if (uniform_)
        return xi * length_;
    return std::clamp(closest_ + height_ * std::sinh(begin_ + xi * range_) / sine_, 0.0, length_);
}

double InverseDistanceDensity::pdf(double t) const {
    return uniform_ ? 1.0 / length_ : sine_ / (range_ * std::hypot(height_, (t - closest_) * sine_));
}

PairDensity::PairDensity(const Segment& camera, const Segment& light, double mean_cosine, double radius)
    : camera_(camera), light_(light), g_(mean_cosine), radius_(radius), marginal_(light, camera, radius) {}

AngularDensity PairDensity::on_camera(double v) const {
    return {light_.at(v), camera_, {{light_.direction, g_}, {-camera_.direction, g_}}, radius_};
}

// Seen from u, light travels against the direction from the apex.
AngularDensity PairDensity::on_light(double u) const {
    return {camera_.at(u), light_, {{-light_.direction, g_}, {camera_.direction, g_}}, radius_};
}

std::optional<PairSample> PairDensity::sample(Rng& rng) const {
    if (!(camera_.length > 0.0) || !(light_.length > 0.0))
        return std::nullopt;
    PairSample s;
    s.v = marginal_.sample(rng);
    const AngularDensity on_camera_ray = on_camera(s.v);
    s.u = on_camera_ray.sample(rng);
    s.pdf = marginal_.pdf(s.v) * on_camera_ray.pdf(s.u);
    return s;
}

double PairDensity::pdf(double u, double v) const {
    return marginal_.pdf(v) * on_camera(v).pdf(u);
}

}  // namespace brisance
