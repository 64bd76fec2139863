#include "emitters/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

using std::numbers::pi;

double angle_between(const dvec3& a, const dvec3& b) {
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

struct Cone {
    dvec3 axis;
    double spread;
};

// The least cone around two.
Cone united(const Cone& a, const Cone& b) {
    const Cone &wide = a.spread >= b.spread ? a : b, &narrow = a.spread >= b.spread ? b : a;
    const double between = angle_between(wide.axis, narrow.axis);
    if (std::min(between + narrow.spread, pi) <= wide.spread)
        return wide;
    const double spread = 0.5 * (wide.spread + between + narrow.spread);
    const dvec3 across = narrow.axis - glm::dot(narrow.axis, wide.axis) * wide.axis;
    const double length = glm::length(across);
    if (spread >= pi || !(length > 1e-12))
        return {wide.axis, pi};
    const double turn = spread - wide.spread;
    return {glm::normalize(std::cos(turn) * wide.axis + std::sin(turn) / length * across), spread};
}

// Measure of the directions that a group emits into (Conty Estevez and Kulla, equation 1).
double orientation_measure(double spread, double reach) {
    const double far = std::min(spread + reach, pi), cosine = std::cos(spread), sine = std::sin(spread);
    return 2.0 * pi * (1.0 - cosine) +
           pi / 2.0 * (2.0 * far * sine - std::cos(spread - 2.0 * far) - 2.0 * spread * sine + cosine);
}

// What a group costs to have in one node; boxes that are long along the axis they are split by cost less.
double cost(const LightBounds& b, const dvec3& parent_size, int axis) {
    const dvec3 size = b.high - b.low;
    const double area = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const double longest = std::max({parent_size.x, parent_size.y, parent_size.z});
    return b.intensity * orientation_measure(b.spread, b.reach) * longest / std::max(parent_size[axis], 1e-300) * area;
}

// From 0 to pi.
struct Angle {
    double cosine, sine;
    static Angle of_cosine(double c) { return {c, std::sqrt(std::max(0.0, (1.0 - c) * (1.0 + c)))}; }
    static Angle of_sine(double s) { return {std::sqrt(std::max(0.0, (1.0 - s) * (1.0 + s))), s}; }  // up to pi / 2
    // Down to 0.
    Angle less(const Angle& other) const {
        if (cosine >= other.cosine)
            return {1.0, 0.0};
        return {cosine * other.cosine + sine * other.sine, sine * other.cosine - cosine * other.sine};
    }
};

// By how much the cosine of a reach of pi / 2 may be below 0.
constexpr double kRightAngle = 1e-12;

dvec3 middle(const LightBounds& b) {
    return 0.5 * (b.low + b.high);
}

struct Split {
    int axis = -1;
    double position = 0.0, cost = 0.0;
};

constexpr int kBuckets = 12;

// The bucket borders along one axis, priced.
void try_axis(const std::vector<LightBounds>& lights, const std::vector<std::uint32_t>& order, std::size_t begin,
              std::size_t end, const LightBounds& all, const dvec3& low, const dvec3& high, int axis, Split& best) {
    const double width = high[axis] - low[axis];
    if (!(width > 0.0))
        return;
    std::array<std::optional<LightBounds>, kBuckets> buckets;
    for (std::size_t i = begin; i < end; ++i) {
        const LightBounds& light = lights[order[i]];
        const int b = std::min(kBuckets - 1, static_cast<int>((middle(light)[axis] - low[axis]) / width * kBuckets));
        buckets[b] = buckets[b] ? united(*buckets[b], light) : light;
    }
    std::array<std::optional<LightBounds>, kBuckets> from_right = buckets;
    for (int b = kBuckets - 2; b >= 0; --b)
        if (from_right[b + 1])
            from_right[b] = from_right[b] ? united(*from_right[b], *from_right[b + 1]) : from_right[b + 1];
    std::optional<LightBounds> left;
    for (int b = 0; b + 1 < kBuckets; ++b) {
        if (buckets[b])
            left = left ? united(*left, *buckets[b]) : *buckets[b];
        if (!left || !from_right[b + 1])
            continue;
        const dvec3 size = all.high - all.low;
        const double price = cost(*left, size, axis) + cost(*from_right[b + 1], size, axis);
        if (best.axis < 0 || price < best.cost)
            best = {axis, low[axis] + width * (b + 1) / kBuckets, price};
    }
}

}  // namespace

LightBounds united(const LightBounds& a, const LightBounds& b) {
    if ((a.distance > 0.0) != (b.distance > 0.0)) {
        LightBounds out = a.distance > 0.0 ? b : a;
        out.spread = pi;
        out.reach = pi / 2.0;
        out.intensity = a.intensity + b.intensity;
        out.distance = std::max(a.distance, b.distance);
        out.near_too = true;
        return out;
    }
    const Cone cone = united(Cone{a.axis, a.spread}, Cone{b.axis, b.spread});
    LightBounds out;
    out.low = glm::min(a.low, b.low);
    out.high = glm::max(a.high, b.high);
    out.axis = cone.axis;
    out.spread = cone.spread;
    out.reach = std::max(a.reach, b.reach);
    out.intensity = a.intensity + b.intensity;
    out.two_sided = a.two_sided || b.two_sided;
    out.distance = std::max(a.distance, b.distance);
    out.near_too = a.near_too || b.near_too;
    return out;
}

LightCone::LightCone(const LightBounds& b)
    : middle_(middle(b)),
      axis_(b.axis),
      radius2_(0.25 * glm::dot(b.high - b.low, b.high - b.low)),
      intensity_(b.intensity),
      half_(0.5 * (b.high - b.low)),
      cos_spread_(std::cos(b.spread)),
      sin_spread_(std::sin(b.spread)),
      cos_reach_(std::cos(b.reach)),
      far2_(b.distance * b.distance),
      two_sided_(b.two_sided),
      near_(!(b.distance > 0.0) || b.near_too) {}

double LightCone::importance_of_far(const LitPoint& point) const {
    double received = 1.0;
    if (point.kind != LitPoint::Kind::Medium) {
        const double toward = -glm::dot(point.normal, axis_);
        const bool both = point.kind == LitPoint::Kind::Transmitting;
        received = Angle::of_cosine(both ? std::abs(toward) : toward).less({cos_spread_, sin_spread_}).cosine;
    }
    return std::max(0.0, intensity_ * received / far2_);
}

double LightCone::importance(const LitPoint& point) const {
    if (!near_)
        return importance_of_far(point);
    const dvec3 from = point.position - middle_;
    const double distance2 = glm::dot(from, from);
    if (!(distance2 > 0.0))
        return intensity_ / std::max(radius2_, 1e-300);
    if (distance2 <= radius2_)  // inside the ball, which is all around the point
        return intensity_ / radius2_;
    const dvec3 direction = from / std::sqrt(distance2);
    // The box as seen from the point, by its ball.
    const Angle around = Angle::of_sine(std::sqrt(radius2_ / distance2));
    const double along = glm::dot(axis_, direction);
    const Angle off =
        Angle::of_cosine(two_sided_ ? std::abs(along) : along).less({cos_spread_, sin_spread_}).less(around);
    if (off.cosine <= cos_reach_)
        return 0.0;
    // Full intensity along each light's axis; what lies beyond a right angle emits alike everywhere.
    const double emitted = cos_reach_ >= -kRightAngle ? off.cosine : 1.0;
    double received = 1.0;
    if (point.kind != LitPoint::Kind::Medium) {
        const double toward = -glm::dot(point.normal, direction);
        const bool both = point.kind == LitPoint::Kind::Transmitting;
        received = Angle::of_cosine(both ? std::abs(toward) : toward).less(around).cosine;
    }
    return std::max(0.0, intensity_ * emitted * received / distance2);
}

// Offsets from a box of points to the lights' box fill a box as large as both together.
LightsInView LightCone::seen_from(const dvec3& point, const dvec3& around) const {
    LightsInView out;
    if (!near_)
        return {intensity_, far2_, far2_, -axis_, cos_spread_};
    const dvec3 offset = middle_ - point, apart = glm::abs(offset), half = dvec3(half_) + around;
    const double radius2 = around == dvec3(0.0) ? radius2_ : glm::dot(half, half);
    const dvec3 near = glm::max(apart - half, dvec3(0.0)), far = apart + half;
    out.nearest2 = glm::dot(near, near);
    out.farthest2 = glm::dot(far, far);
    out.intensity = intensity_;
    if (far2_ > 0.0) {
        out.nearest2 = std::min(out.nearest2, far2_);
        out.farthest2 = std::max(out.farthest2, far2_);
        return out;
    }
    const double distance2 = glm::dot(offset, offset);
    if (distance2 <= radius2 || !(distance2 > 0.0))
        return out;
    out.direction = offset / std::sqrt(distance2);
    const Angle wide = Angle::of_sine(std::sqrt(radius2 / distance2));
    out.cos_around = wide.cosine;
    const double along = -glm::dot(axis_, out.direction);
    const Angle off =
        Angle::of_cosine(two_sided_ ? std::abs(along) : along).less({cos_spread_, sin_spread_}).less(wide);
    const double emitted = cos_reach_ >= -kRightAngle ? off.cosine : 1.0;
    out.intensity = off.cosine <= cos_reach_ ? 0.0 : intensity_ * std::max(0.0, emitted);
    return out;
}

LightTree::LightTree(const std::vector<LightBounds>& lights) : leaf_of_(lights.size()) {
    if (lights.empty())
        return;
    std::vector<std::uint32_t> order(lights.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    nodes_.reserve(2 * lights.size());
    build(order, lights, 0, lights.size(), 0);
}

std::uint32_t LightTree::build(std::vector<std::uint32_t>& order, const std::vector<LightBounds>& lights,
                               std::size_t begin, std::size_t end, std::uint32_t parent) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({});
    nodes_[node].parent = parent;
    if (end - begin == 1) {
        nodes_[node].lights = LightCone(lights[order[begin]]);
        nodes_[node].right = order[begin];
        leaf_of_[order[begin]] = node;
        return node;
    }
    LightBounds all = lights[order[begin]];
    for (std::size_t i = begin + 1; i < end; ++i)
        all = united(all, lights[order[i]]);
    const std::size_t cut = divide(order, lights, begin, end, all);
    const std::uint32_t left = build(order, lights, begin, cut, node);
    const std::uint32_t right = build(order, lights, cut, end, node);
    nodes_[node].lights = LightCone(all);
    nodes_[node].left = left;
    nodes_[node].right = right;
    return node;
}

// Orders the lights from `begin` to `end`, of which there are two or more, and returns where the right half begins.
std::size_t LightTree::divide(std::vector<std::uint32_t>& order, const std::vector<LightBounds>& lights,
                              std::size_t begin, std::size_t end, const LightBounds& all) {
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(end);
    const auto position_of = [&](auto there) { return static_cast<std::size_t>(there - order.begin()); };
    if (all.distance > 0.0 && all.near_too)
        return position_of(
            std::stable_partition(first, last, [&](std::uint32_t i) { return !(lights[i].distance > 0.0); }));
    dvec3 low(1e300), high(-1e300);
    for (auto i = first; i != last; ++i) {
        low = glm::min(low, middle(lights[*i]));
        high = glm::max(high, middle(lights[*i]));
    }
    Split best;
    for (int axis = 0; axis < 3; ++axis)
        try_axis(lights, order, begin, end, all, low, high, axis, best);
    if (best.axis >= 0) {
        const auto there = std::stable_partition(
            first, last, [&](std::uint32_t i) { return middle(lights[i])[best.axis] < best.position; });
        if (there != first && there != last)
            return position_of(there);
    }
    return begin + (end - begin) / 2;
}

// Below 0: neither can reach the point.
double LightTree::share_of_left(const Node& node, const LitPoint& point) const {
    const double left = nodes_[node.left].lights.importance(point);
    const double right = nodes_[node.right].lights.importance(point);
    return left + right > 0.0 ? left / (left + right) : -1.0;
}

std::optional<LightTree::Choice> LightTree::choose(const LitPoint& point, double u) const {
    return nodes_.empty() ? std::nullopt : choose_from(0, point, u);
}

std::optional<LightTree::Choice> LightTree::choose_from(std::uint32_t node, const LitPoint& point, double u) const {
    const auto found = descend(
        nodes_, u, [&](const Node& n) { return share_of_left(n, point); }, node);
    if (!found || !(nodes_[found->leaf].lights.importance(point) > 0.0))
        return std::nullopt;
    return Choice{nodes_[found->leaf].right, found->probability};
}

double LightTree::probability(const LitPoint& point, std::size_t light) const {
    const std::uint32_t leaf = leaf_of_[light];
    if (!(nodes_[leaf].lights.importance(point) > 0.0))
        return 0.0;
    return descent_probability(nodes_, leaf, [&](const Node& n) { return share_of_left(n, point); });
}

}  // namespace brisance
