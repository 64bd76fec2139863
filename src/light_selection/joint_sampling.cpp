#include "light_selection/joint_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// Below this range of asinh the inverse distance varies by less than a thousandth over the ray, and the difference of
// two asinh would lose its digits.
constexpr double kUniformRange = 1e-3;

}  // namespace

double phase_about(const dvec3& axis, const dvec3& direction, double g) {
    const dvec3 apart = g < 0.0 ? axis + direction : axis - direction;
    const double a = std::abs(g), one_minus_cosine = 0.5 * glm::dot(apart, apart);
    const double d = (1.0 - a) * (1.0 - a) + 2.0 * a * one_minus_cosine;
    return (1.0 - a) * (1.0 + a) / (2.0 * kTwoPi * d * std::sqrt(d));
}

AngularDensity::AngularDensity(const dvec3& apex, const Segment& segment, std::initializer_list<PhaseLobe> lobes,
                               double radius)
    : seen_(apex, segment, radius) {
    for (const PhaseLobe& lobe : lobes)
        if (lobe.mean_cosine != 0.0) {
            peaks_[count_] = seen_.peak(lobe);
            count_ += seen_.resolves(peaks_[count_]);
        }
}

double AngularDensity::sample(Rng& rng) const {
    const int choice = std::min(count_, static_cast<int>(rng.next_double() * (count_ + 1)));
    const double xi = rng.next_double();
    if (choice == 0)
        return seen_.distance_at(xi * seen_.whole());
    const double angle = peaks_[choice - 1].quantile(xi) - seen_.begin();
    return seen_.distance_at(std::clamp(angle, 0.0, seen_.whole()));
}

double AngularDensity::pdf(double t) const {
    double per_angle = 1.0 / seen_.whole();
    for (int i = 0; i < count_; ++i)
        per_angle += 1.0 / (peaks_[i].integral * peaks_[i].base(seen_.at(t)));
    return per_angle / (count_ + 1) * seen_.per_metre(t);
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

double InverseDistanceDensity::cumulative(double t) const {
    return uniform_ ? t / length_ : (std::asinh((t - closest_) * sine_ / height_) - begin_) / range_;
}

double InverseDistanceDensity::pdf(double t) const {
    return uniform_ ? 1.0 / length_ : sine_ / (range_ * std::hypot(height_, (t - closest_) * sine_));
}

InverseDistanceDensity ClosedFormSampling::on_light(const Segment& camera, const Segment& light, double,
                                                    double radius) {
    return {light, camera, radius};
}

}  // namespace brisance
