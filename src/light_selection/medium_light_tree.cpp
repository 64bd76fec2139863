#include "light_selection/medium_light_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "emitters/tree_descent.h"

namespace brisance {

namespace {

dvec3 middle(const MediumLightBounds& b) {
    return 0.5 * (b.low + b.high);
}

// Least cosine factor of a box: lights below the horizon of its centre may still be above that of the surface.
constexpr double kBelowHorizon = 0.05;
// Largest |g| of the phase functions, so that no box that may contribute is left out.
constexpr double kSharpest = 0.8;
// Fraction of choices by power alone. Where boxes hold lights of many directions, the tree may underestimate a light
// that shines straight at the camera by a factor of a million; when chosen, that light would outshine all others.
constexpr double kByPower = 0.125;
// Directions from a box to a ray at which the phase functions are evaluated.
constexpr int kDirections = 2;

// The angular radius of a box as seen from a point, about the direction to its centre.
struct Width {
    double sine, cosine;
    Width(double radius, double distance)
        : sine(distance > radius ? radius / distance : 1.0), cosine(std::sqrt((1.0 - sine) * (1.0 + sine))) {}
};

// The largest phase function among all directions within the angular radius; its peak where the box contains the point.
// A near box has lights that shine at the point and others that shine away from it, and an underestimate costs more
// than an overestimate.
double phase_within(double cosine, double g, const Width& width) {
    const double a = std::min(std::abs(g), kSharpest), c = std::clamp(g < 0.0 ? -cosine : cosine, -1.0, 1.0);
    double nearest = 1.0;
    if (width.sine < 1.0 && c < width.cosine)
        nearest = c * width.cosine + std::sqrt((1.0 - c) * (1.0 + c)) * width.sine;
    const double d = (1.0 - a) * (1.0 - a) + 2.0 * a * (1.0 - nearest);
    return (1.0 - a) * (1.0 + a) / (4.0 * std::numbers::pi * d * std::sqrt(d));
}

// For lights of several directions: the mean cosine after two deflections is the product of both.
double phase_of(const MediumLightBounds& box, const dvec3& toward, double g, const Width& width) {
    const double length = glm::length(box.heading);
    const double cosine = length > 0.0 ? glm::dot(box.heading, toward) / length : 0.0;
    return phase_within(cosine, g * length, width);
}

double along_ray(const MediumLightBounds& box, const Segment& ray, double g) {
    const dvec3 from = middle(box), offset = ray.start - from;
    const double radius = 0.5 * glm::length(box.high - box.low), begin = glm::dot(offset, ray.direction);
    const dvec3 across = offset - begin * ray.direction;
    const double floor = 1e-12 * std::max(ray.length, 1e-280);
    const double height = std::max(std::sqrt(glm::dot(across, across) + 0.25 * radius * radius), floor);
    // The integral of 1 / (distance^2 + radius^2 / 4) is an angle over the height.
    const double angle = std::atan2(height * ray.length, height * height + begin * (begin + ray.length));
    const double nearest = glm::length(offset + std::clamp(-begin, 0.0, ray.length) * ray.direction);
    const double seen = guessed_transmittance(box.extinction * std::max(0.0, nearest - radius)) * angle / height;
    if (g == 0.0)
        return seen;
    const double first = std::atan2(begin, height);
    double phases = 0.0;
    for (int i = 0; i < kDirections; ++i) {
        const double a = first + (i + 0.5) / kDirections * angle;
        const dvec3 to_ray = across + height * std::tan(a) * ray.direction;
        const double distance = glm::length(to_ray);
        const dvec3 toward = distance > 0.0 ? to_ray / distance : ray.direction;
        const Width width(radius, distance);
        phases += phase_of(box, toward, g, width) * phase_within(-glm::dot(toward, ray.direction), g, width);
    }
    return phases / kDirections * seen;
}

double at_point(const MediumLightBounds& box, const dvec3& point, const dvec3& normal, double g) {
    const dvec3 offset = middle(box) - point;
    const double radius = 0.5 * glm::length(box.high - box.low), distance = glm::length(offset);
    const double softened2 = std::max(distance * distance + 0.25 * radius * radius, 1e-280);
    const double cosine = std::clamp((glm::dot(offset, normal) + radius) / std::sqrt(softened2), kBelowHorizon, 1.0);
    const dvec3 toward = distance > 0.0 ? -offset / distance : normal;
    const double phase = g != 0.0 ? phase_of(box, toward, g, Width(radius, distance)) : 1.0;
    return guessed_transmittance(box.extinction * std::max(0.0, distance - radius)) * phase * cosine / softened2;
}

}  // namespace

MediumLightBounds united(const MediumLightBounds& a, const MediumLightBounds& b) {
    const double all = a.scattered + b.scattered;
    const double part = all > 0.0 ? a.scattered / all : 0.5;
    const dvec3 heading = part * a.heading + (1.0 - part) * b.heading;
    const double extinction = std::lerp(b.extinction, a.extinction, part);
    return {glm::min(a.low, b.low), glm::max(a.high, b.high), all, extinction, heading};
}

double importance(const MediumLightBounds& box, const LightReceiver& receiver, double g) {
    return box.scattered *
           (receiver.is_ray ? along_ray(box, receiver.ray, g) : at_point(box, receiver.point, receiver.normal, g));
}

MediumLightTree::MediumLightTree(std::span<const MediumLightBounds> lights, double mean_cosine)
    : mean_cosine_(mean_cosine), leaf_of_(lights.size()) {
    if (lights.empty())
        return;
    std::vector<std::uint32_t> order(lights.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    nodes_.reserve(2 * lights.size());
    build(lights, order, 0);
}

// Halves by number along the longest side of the box around the centres: depth is at most the logarithm of the number.
std::uint32_t MediumLightTree::build(std::span<const MediumLightBounds> lights, std::span<std::uint32_t> order,
                                     std::uint32_t parent) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({lights[order[0]], parent, 0, order[0]});
    if (order.size() == 1) {
        leaf_of_[order[0]] = node;
        return node;
    }
    MediumLightBounds all = lights[order[0]];
    dvec3 low = middle(all), high = low;
    for (const std::uint32_t i : order.subspan(1)) {
        all = united(all, lights[i]);
        low = glm::min(low, middle(lights[i]));
        high = glm::max(high, middle(lights[i]));
    }
    const dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                     [&](std::uint32_t i, std::uint32_t j) {
                         const double x = middle(lights[i])[axis], y = middle(lights[j])[axis];
                         return x != y ? x < y : i < j;
                     });
    const std::uint32_t left = build(lights, order.first(half), node);
    const std::uint32_t right = build(lights, order.subspan(half), node);
    nodes_[node].bounds = all;
    nodes_[node].left = left;
    nodes_[node].right = right;
    return node;
}

// Probability of the left branch; below 0 if there is no light.
double MediumLightTree::share_of_left(const Node& node, const LightReceiver& receiver) const {
    const double left = importance(nodes_[node.left].bounds, receiver, mean_cosine_);
    const double right = importance(nodes_[node.right].bounds, receiver, mean_cosine_);
    return left + right > 0.0 ? left / (left + right) : -1.0;
}

double MediumLightTree::share_of_power(const Node& node) const {
    const double left = nodes_[node.left].bounds.scattered, right = nodes_[node.right].bounds.scattered;
    return left + right > 0.0 ? left / (left + right) : -1.0;
}

std::optional<MediumLightTree::Choice> MediumLightTree::choose(const LightReceiver& receiver, double u) const {
    if (nodes_.empty())
        return std::nullopt;
    const bool by_power = u < kByPower;
    const auto found = by_power ? descend(nodes_, u / kByPower, [&](const Node& n) { return share_of_power(n); })
                                : descend(nodes_, (u - kByPower) / (1.0 - kByPower),
                                          [&](const Node& n) { return share_of_left(n, receiver); });
    if (!found)
        return std::nullopt;
    const std::size_t light = nodes_[found->leaf].right;
    const double by_receiver = by_power ? probability_by_receiver(receiver, light) : found->probability;
    return Choice{light, mixed(by_receiver, light), 1 + 2 * found->branches};
}

double MediumLightTree::probability_by_receiver(const LightReceiver& receiver, std::size_t light) const {
    return descent_probability(nodes_, leaf_of_[light], [&](const Node& n) { return share_of_left(n, receiver); });
}

double MediumLightTree::mixed(double by_receiver, std::size_t light) const {
    const double all = nodes_[0].bounds.scattered;
    const double by_power = all > 0.0 ? nodes_[leaf_of_[light]].bounds.scattered / all : 0.0;
    return std::lerp(by_receiver, by_power, kByPower);
}

double MediumLightTree::probability(const LightReceiver& receiver, std::size_t light) const {
    return mixed(probability_by_receiver(receiver, light), light);
}

}  // namespace brisance
