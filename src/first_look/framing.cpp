#include <algorithm>
#include <cmath>
#include <numeric>

#include "first_look/view.h"

namespace brisance {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr double kOutside = 0.004;  // share of what is seen that may lie beyond each side
constexpr int kSteps = 12;          // of the search for the distance, which converges geometrically

struct Interval {
    double low = INFINITY, high = -INFINITY;
    void join(const Interval& other) {
        low = std::min(low, other.low);
        high = std::max(high, other.high);
    }
};

// Between the quantiles `kOutside` and 1 - `kOutside` of weighted values.
Interval inner(const std::vector<double>& values, const std::vector<double>& weights) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    Interval out;
    if (!(total > 0.0))
        return out;
    double below = 0.0;
    for (const std::size_t i : order) {
        below += weights[i];
        if (below <= kOutside * total)
            continue;
        out.low = std::min(out.low, values[i]);
        out.high = values[i];
        if (below >= (1.0 - kOutside) * total)
            break;
    }
    return out;
}

struct Extent {
    Interval across, upright;  // tangents of the angle from the axis of view
};

// As seen from a camera; cells behind or close to it count as close before it.
Extent extent_of(const View& view, const Seen& seen, const ViewAxes& axes, const dvec3& eye, double nearest) {
    std::vector<double> across, upright, weight;
    for (std::size_t i = 0; i < view.cells.size(); ++i) {
        if (!(seen.weight[i] > 0.0))
            continue;
        const dvec3 away = view.cells[i].position - eye;
        const double depth = std::max(-glm::dot(away, axes.back), nearest);
        across.push_back(glm::dot(away, axes.right) / depth);
        upright.push_back(glm::dot(away, axes.up) / depth);
        weight.push_back(seen.weight[i]);
    }
    return {inner(across, weight), inner(upright, weight)};
}

}  // namespace

std::optional<Framing> frame_on(std::span<const View> views, std::span<const Seen> seen, const ViewAxes& axes,
                                double vertical_fov_degrees, double aspect, double fill) {
    dvec3 low(INFINITY), high(-INFINITY);
    double finest = INFINITY;
    for (std::size_t f = 0; f < views.size(); ++f) {
        std::vector<double> along[3];
        for (const ViewCell& c : views[f].cells)
            for (int a = 0; a < 3; ++a)
                along[a].push_back(c.position[a]);
        for (int a = 0; a < 3; ++a) {
            const Interval range = inner(along[a], seen[f].weight);
            low[a] = std::min(low[a], range.low), high[a] = std::max(high[a], range.high);
        }
        if (!views[f].cells.empty())
            finest = std::min(finest, views[f].cell_metres);
    }
    if (!(low.x <= high.x))
        return std::nullopt;
    const double tangent = std::tan(0.5 * vertical_fov_degrees * kDegree);
    const double size = std::max(glm::length(high - low), finest);
    double distance = size / tangent;
    Framing out;
    out.target = 0.5 * (low + high);
    for (int step = 0; step < kSteps; ++step) {
        out.eye = out.target + distance * axes.back;
        Interval across, upright;
        for (std::size_t f = 0; f < views.size(); ++f) {
            const Extent e = extent_of(views[f], seen[f], axes, out.eye, 0.05 * distance);
            across.join(e.across), upright.join(e.upright);
        }
        const double cell = 0.5 * finest / distance;
        out.fill[0] = (0.5 * (across.high - across.low) + cell) / (tangent * aspect);
        out.fill[1] = (0.5 * (upright.high - upright.low) + cell) / tangent;
        out.target +=
            distance * (0.5 * (across.low + across.high) * axes.right + 0.5 * (upright.low + upright.high) * axes.up);
        distance *= std::max(out.fill[0], out.fill[1]) / fill;
    }
    out.eye = out.target + distance * axes.back;
    return out;
}

}  // namespace brisance
