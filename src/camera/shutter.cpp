#include "camera/shutter.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Openness over the shutter's time, from 0 to 1: its integral, and the inverse of that.
class Openness {
public:
    explicit Openness(const std::vector<vec2>& curve) : curve_(curve) {
        if (curve_.empty())
            curve_ = {{0.0f, 1.0f}, {1.0f, 1.0f}};
        areas_.push_back(0.0);
        for (std::size_t i = 1; i < curve_.size(); ++i)
            areas_.push_back(areas_.back() +
                             0.5 * (double(curve_[i].x) - curve_[i - 1].x) * (double(curve_[i].y) + curve_[i - 1].y));
    }

    // The time up to which a share of all light has come through.
    double time_at(double share) const {
        const double area = share * areas_.back();
        std::size_t i = 1;
        while (i + 1 < areas_.size() && areas_[i] < area)
            ++i;
        const double from = curve_[i - 1].x, length = curve_[i].x - from;
        const double low = curve_[i - 1].y, rise = curve_[i].y - low, left = area - areas_[i - 1];
        // left = length (low t + rise t^2 / 2), solved without cancellation.
        const double root = std::sqrt(std::max(0.0, low * low + 2.0 * rise * left / length));
        const double t = low + root > 0.0 ? 2.0 * left / (length * (low + root)) : 0.0;
        return from + length * std::clamp(t, 0.0, 1.0);
    }

private:
    std::vector<vec2> curve_;
    std::vector<double> areas_;  // under the curve up to each of its points
};

}  // namespace

ShutterSpan shutter_span(const ShutterSettings& shutter) {
    const double opens = shutter.position == ShutterPosition::Start    ? 0.0
                         : shutter.position == ShutterPosition::Centre ? -0.5 * shutter.length
                                                                       : -shutter.length;
    return {opens, opens + shutter.length};
}

std::vector<double> shutter_moments(const ShutterSettings& shutter, int count) {
    if (!(shutter.length > 0.0))
        return {0.0};
    const Openness openness(shutter.curve);
    const ShutterSpan span = shutter_span(shutter);
    std::vector<double> moments;
    for (int k = 0; k < count; ++k)
        moments.push_back(span.opens + (span.closes - span.opens) * openness.time_at((k + 0.5) / count));
    return moments;
}

}  // namespace brisance
