#include "ray_lights/ray_light_tree.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

dvec3 middle(const RayLightBounds& b) {
    return 0.5 * (b.low + b.high);
}

// The integral of 1 / (distance^2 + size^2) along the segment, as seen from a point.
double seen_along(const Segment& ray, const dvec3& from, double size) {
    const dvec3 way = from - ray.start;
    const double along = glm::dot(way, ray.direction);
    const double height = std::sqrt(std::max(glm::dot(way, way) - along * along, 0.0) + size * size);
    const double h = std::max(height, 1e-12 * std::max(ray.length, 1e-280));
    return std::atan2(h * ray.length, h * h + along * (along - ray.length)) / h;
}

// Lights below the horizon of the box's middle may still be above that of the surface: they keep a part.
constexpr double kBelowHorizon = 0.05;

}  // namespace

RayLightBounds bounds_of(const RayLight& light) {
    const dvec3 a = light.segment.start, b = light.segment.at(light.segment.length);
    return {glm::min(a, b), glm::max(a, b), light.scattered};
}

double importance(const RayLightBounds& box, const RayLightReceiver& receiver) {
    const dvec3 centre = middle(box);
    const double radius = 0.5 * glm::length(box.high - box.low);
    if (receiver.is_ray)
        return box.scattered * seen_along(receiver.ray, centre, 0.5 * radius);
    const dvec3 way = centre - receiver.point;
    const double distance2 = std::max({glm::dot(way, way), 0.25 * radius * radius, 1e-280});
    const double cosine = (glm::dot(way, receiver.normal) + radius) / std::sqrt(distance2);
    return box.scattered * std::clamp(cosine, kBelowHorizon, 1.0) / distance2;
}

RayLightTree::RayLightTree(std::span<const RayLight> lights) : leaf_of_(lights.size()) {
    if (lights.empty())
        return;
    std::vector<RayLightBounds> bounds;
    bounds.reserve(lights.size());
    for (const RayLight& light : lights)
        bounds.push_back(bounds_of(light));
    std::vector<std::uint32_t> order(lights.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    nodes_.reserve(2 * lights.size());
    build(bounds, order, 0);
}

// Halves by number along the longest side of the middles' box: no path is longer than the logarithm.
std::uint32_t RayLightTree::build(std::span<const RayLightBounds> lights, std::span<std::uint32_t> order,
                                  std::uint32_t parent) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({lights[order[0]], parent, 0, order[0]});
    if (order.size() == 1) {
        leaf_of_[order[0]] = node;
        return node;
    }
    RayLightBounds all = lights[order[0]];
    dvec3 low = middle(all), high = low;
    for (const std::uint32_t i : order.subspan(1)) {
        all = {glm::min(all.low, lights[i].low), glm::max(all.high, lights[i].high),
               all.scattered + lights[i].scattered};
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

// Below 0: there is no light.
double RayLightTree::share_of_left(const Node& node, const RayLightReceiver& receiver) const {
    const double left = importance(nodes_[node.left].bounds, receiver);
    const double right = importance(nodes_[node.right].bounds, receiver);
    return left + right > 0.0 ? left / (left + right) : -1.0;
}

std::optional<RayLightTree::Choice> RayLightTree::choose(const RayLightReceiver& receiver, double u) const {
    if (nodes_.empty())
        return std::nullopt;
    Choice choice{0, 1.0, 1};
    std::uint32_t at = 0;
    while (nodes_[at].left != 0) {
        const double left = share_of_left(nodes_[at], receiver);
        if (left < 0.0)
            return std::nullopt;
        const bool goes_left = u < left;
        const double share = goes_left ? left : 1.0 - left;
        u = std::min((goes_left ? u : u - left) / share, 1.0 - 0x1p-53);
        choice.probability *= share;
        choice.visited += 2;
        at = goes_left ? nodes_[at].left : nodes_[at].right;
    }
    choice.light = nodes_[at].right;
    return choice;
}

double RayLightTree::probability(const RayLightReceiver& receiver, std::size_t light) const {
    double probability = 1.0;
    for (std::uint32_t at = leaf_of_[light]; at != 0; at = nodes_[at].parent) {
        const std::uint32_t parent = nodes_[at].parent;
        const double left = share_of_left(nodes_[parent], receiver);
        if (left < 0.0)
            return 0.0;
        probability *= nodes_[parent].left == at ? left : 1.0 - left;
    }
    return probability;
}

}  // namespace brisance
