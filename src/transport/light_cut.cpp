#include "transport/light_cut.h"

#include "core/rng.h"

namespace brisance {

namespace {

constexpr Stream kRepresentatives = stream_of("virtual_lights/representatives");

// Of the left one. Both weights are above 0 or not finite only where distances are 0.
double share(double left, double right, double left_distance2, double right_distance2) {
    const double a = left * right_distance2, b = right * left_distance2;
    return a + b > 0.0 ? a / (a + b) : -1.0;
}

}  // namespace

double share_by_distances(const NodeBound& left, const NodeBound& right) {
    if (!(left.scattered + right.scattered > 0.0))
        return -1.0;
    if (!(left.scattered > 0.0) || !(right.scattered > 0.0))
        return left.scattered > 0.0 ? 1.0 : 0.0;
    const double far =
        share(left.dimmed(left.farthest2), right.dimmed(right.farthest2), left.farthest2, right.farthest2);
    const double near = share(left.dimmed(left.nearest2), right.dimmed(right.nearest2), left.nearest2, right.nearest2);
    // Boxes of no size where the vertex is: by power alone.
    if (far < 0.0)
        return left.scattered / (left.scattered + right.scattered);
    return near < 0.0 ? far : 0.5 * (near + far);
}

// Children have greater numbers than their parents.
std::vector<NodeLimit> limits_of_nodes(const LightTree& tree, const LightLimits& of_lights) {
    if (of_lights.least2.empty())
        return {};
    // Intensity over squared distance: infinite where a light is not bounded.
    std::vector<double> most(tree.node_count());
    std::vector<LightBounds> boxes(tree.node_count());
    std::vector<NodeLimit> out(tree.node_count());
    for (auto node = static_cast<std::uint32_t>(out.size()); node-- > 0;) {
        const double intensity = tree.lights(node).intensity();
        if (tree.is_leaf(node)) {
            boxes[node] = of_lights.bounds[tree.light(node)];
            most[node] = intensity > 0.0 ? intensity / of_lights.least2[tree.light(node)] : 0.0;
        } else {
            boxes[node] = united(boxes[tree.left(node)], boxes[tree.right(node)]);
            most[node] = most[tree.left(node)] + most[tree.right(node)];
        }
        const LightBounds& box = boxes[node];
        out[node] = {0.5 * (box.low + box.high), 0.5 * (box.high - box.low),
                     most[node] > 0.0 ? static_cast<float>(intensity / most[node]) : 0.0f, box.distance > 0.0};
    }
    return out;
}

// A cosine is at most the height over the plane, over the least distance: a bound beside that by the cone of
// directions, which is all of them where the vertex lies among the lights. Rounding lifts lights of the plane that it
// lies in: they keep a little, since a random choice must not lose them.
double VertexBounds::largest_cosine(const NodeLimit& limit, const LightsInView& view) const {
    constexpr double kLeastCosine = 1e-4, kRounding = 1e-6;
    const LitPoint& point = vertex_.lit();
    if (limit.far || point.kind != LitPoint::Kind::Surface)
        return 1.0;
    const double height = limit.height(point.position, point.normal), nearest = std::sqrt(view.nearest2);
    if (height <= 0.0)
        return 0.0;
    if (height < kRounding * std::sqrt(view.farthest2))
        return kLeastCosine;
    return height < nearest ? height / nearest : 1.0;
}

// Children have greater numbers than their parents.
std::vector<std::uint32_t> representatives(const LightTree& tree, std::uint32_t seed) {
    std::vector<std::uint32_t> out(tree.node_count());
    for (auto node = static_cast<std::uint32_t>(out.size()); node-- > 0;) {
        if (tree.is_leaf(node)) {
            out[node] = static_cast<std::uint32_t>(tree.light(node));
            continue;
        }
        const double left = tree.lights(tree.left(node)).intensity(), right = tree.lights(tree.right(node)).intensity();
        const bool takes_left = Rng(kRepresentatives, node, seed).next_double() * (left + right) < left;
        out[node] = out[takes_left ? tree.left(node) : tree.right(node)];
    }
    return out;
}

}  // namespace brisance
