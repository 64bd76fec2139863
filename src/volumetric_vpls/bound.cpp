#include "volumetric_vpls/bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

constexpr double kInBall = 8.0;

}  // namespace

double Bound::radius() const {
    return limits() ? 1.0 / std::sqrt(bound_) : 0.0;
}

double Bound::of(double inverse_square) const {
    return limits() ? std::min(inverse_square, bound_) : inverse_square;
}

double Bound::part_left_out(double distance) const {
    return limits() ? std::max(0.0, 1.0 - bound_ * distance * distance) : 0.0;
}

// 1 - 2 (1 - exp(-x) (1 + x)) / x^2 with the optical radius x; its series where that would lose its digits.
double Bound::share_left_out(double extinction) const {
    const double x = extinction * radius();
    if (x < 0.01)
        return x * (2.0 / 3.0 - x * (0.25 - x / 15.0));
    return 1.0 - 2.0 * (1.0 - std::exp(-x) * (1.0 + x)) / (x * x);
}

Bound bound_of(const VolumetricVplSettings& settings, const TrackingField& field) {
    if (settings.bound != kAutomaticBound)
        return Bound(settings.bound);
    const double ball = field.smoke_volume() * kInBall / settings.paths;
    return Bound(ball > 0.0 ? std::pow(0.75 * ball / std::numbers::pi, -2.0 / 3.0) : 0.0);
}

}  // namespace brisance
