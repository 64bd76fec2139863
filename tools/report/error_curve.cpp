#include "error_curve.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace brisance {
namespace {

// y at x on the straight line through two points, all four in logarithms.
double on_line(double x, double x0, double y0, double x1, double y1) {
    if (x0 == x1)
        return y1;
    const double share = (std::log(x) - std::log(x0)) / (std::log(x1) - std::log(x0));
    return std::exp(std::log(y0) + share * (std::log(y1) - std::log(y0)));
}

std::optional<PowerLaw> fit(const std::vector<CurvePoint>& points, double CurvePoint::*against) {
    std::vector<double> xs, ys;
    for (const CurvePoint& p : points)
        if (p.error > 0.0 && p.*against > 0.0) {
            xs.push_back(std::log(p.*against));
            ys.push_back(std::log(p.error));
        }
    if (xs.size() < 2)
        return std::nullopt;
    const auto n = static_cast<double>(xs.size());
    const double mean_x = std::accumulate(xs.begin(), xs.end(), 0.0) / n;
    const double mean_y = std::accumulate(ys.begin(), ys.end(), 0.0) / n;
    double xx = 0.0, xy = 0.0;
    for (std::size_t i = 0; i < xs.size(); ++i) {
        xx += (xs[i] - mean_x) * (xs[i] - mean_x);
        xy += (xs[i] - mean_x) * (ys[i] - mean_y);
    }
    if (!(xx > 0.0))
        return std::nullopt;
    const double exponent = xy / xx;
    return PowerLaw{std::exp(mean_y - exponent * mean_x), exponent};
}

}  // namespace

ErrorCurve::ErrorCurve(std::vector<CurvePoint> points, Tail tail) : points_(std::move(points)), tail_(tail) {
    std::erase_if(points_,
                  [](const CurvePoint& p) { return !(p.seconds > 0.0) || !std::isfinite(p.error) || p.error < 0.0; });
    std::stable_sort(points_.begin(), points_.end(),
                     [](const CurvePoint& a, const CurvePoint& b) { return a.seconds < b.seconds; });
}

std::optional<PowerLaw> ErrorCurve::law() const {
    return fit(points_, &CurvePoint::seconds);
}

std::optional<PowerLaw> ErrorCurve::law_of_work() const {
    return fit(points_, &CurvePoint::work);
}

double ErrorCurve::startup() const {
    if (tail_ == Tail::Floor || points_.size() < 2)
        return 0.0;
    const CurvePoint &a = points_[points_.size() - 2], &b = points_.back();
    if (!(a.work > 0.0) || !(b.work > a.work))
        return 0.0;
    const double per_work = (b.seconds - a.seconds) / (b.work - a.work);
    return std::clamp(a.seconds - per_work * a.work, 0.0, points_.front().seconds);
}

Reading ErrorCurve::time_to(double error) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (points_[i].error > error)
            continue;
        const CurvePoint& now = points_[i];
        if (i == 0 || now.error == 0.0)
            return {now.seconds, now.error == error ? ReadingKind::Interpolated : ReadingKind::AtMost};
        const CurvePoint& before = points_[i - 1];
        return {on_line(error, before.error, before.seconds, now.error, now.seconds), ReadingKind::Interpolated};
    }
    if (points_.empty() || tail_ == Tail::Floor)
        return {};
    const CurvePoint& last = points_.back();
    const double growth = last.error / error;
    return {startup() + (last.seconds - startup()) * growth * growth, ReadingKind::Extrapolated};
}

Reading ErrorCurve::error_after(double seconds) const {
    if (points_.empty() || seconds < points_.front().seconds)
        return {};
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (points_[i].seconds == seconds)
            return {points_[i].error, ReadingKind::Interpolated};
        if (points_[i].seconds < seconds)
            continue;
        const CurvePoint &before = points_[i - 1], &next = points_[i];
        if (before.error == 0.0 || next.error == 0.0)
            return {std::max(before.error, next.error), ReadingKind::AtMost};
        return {on_line(seconds, before.seconds, before.error, next.seconds, next.error), ReadingKind::Interpolated};
    }
    if (tail_ == Tail::Floor)
        return {floor(), ReadingKind::AtMost};
    const CurvePoint& last = points_.back();
    return {last.error * std::sqrt((last.seconds - startup()) / (seconds - startup())), ReadingKind::Extrapolated};
}

double ErrorCurve::floor() const {
    const auto least = std::min_element(points_.begin(), points_.end(),
                                        [](const CurvePoint& a, const CurvePoint& b) { return a.error < b.error; });
    return least == points_.end() ? 0.0 : least->error;
}

}  // namespace brisance
