#include "fire_lights/multidimensional_lightcuts.h"

#include <algorithm>

namespace brisance {

namespace {

// Some points of a ray, one after another.
struct PointNode {
    double weight = 0.0;  // luminance
    std::uint32_t representative = 0;
    std::uint32_t left = 0, right = 0;  // left == 0: a leaf
    dvec3 low{0.0}, high{0.0};
    double extinction = 0.0;  // the least at them [1/m]
    dvec3 middle() const { return 0.5 * (low + high); }
    dvec3 half() const { return 0.5 * (high - low); }
};

std::uint32_t build(std::span<const GatherPoint> points, std::uint32_t begin, std::uint32_t end, Rng& rng,
                    std::vector<PointNode>& nodes) {
    const auto node = static_cast<std::uint32_t>(nodes.size());
    nodes.emplace_back();
    if (end - begin == 1) {
        const dvec3& p = points[begin].vertex.position();
        nodes[node] = {luminance(points[begin].weight), begin, 0, 0, p, p, points[begin].extinction};
        return node;
    }
    const std::uint32_t half = begin + (end - begin) / 2;
    const std::uint32_t left = build(points, begin, half, rng, nodes), right = build(points, half, end, rng, nodes);
    const PointNode &l = nodes[left], &r = nodes[right];
    const bool takes_left = rng.next_double() * (l.weight + r.weight) < l.weight;
    nodes[node] = {l.weight + r.weight,      (takes_left ? l : r).representative, left, right, glm::min(l.low, r.low),
                   glm::max(l.high, r.high), std::min(l.extinction, r.extinction)};
    return node;
}

// CutNode::node is that of the lights.
struct Pair : CutNode {
    std::uint32_t points = 0;
    Rgb light{0.0f};  // of one representative at the other, by the colour of the point's weight
};

// The pairs of one ray.
class Pairs {
public:
    Pairs(const FireLights& lights, const Lightcut& cut, std::span<const GatherPoint> points, Rng& rng)
        : lights_(lights), cut_(cut), points_(points), rng_(rng), scattering_(points[0].vertex.bound()) {
        thread_local std::vector<PointNode> nodes;
        nodes.clear();
        build(points, 0, static_cast<std::uint32_t>(points.size()), rng, nodes);
        nodes_ = &nodes;
    }

    Pair whole() const { return with_bound(0, 0, exchange(0, 0)); }

    Rgb contribution(const Pair& pair) const {
        return pair.light * float(at(pair.points).weight) * cut_.ratio_to_representative(pair.node);
    }

    // Of leaves only one is ever given that errs.
    template <class Add>
    void divide(const Pair& pair, const Add& add) const {
        const PointNode& points = at(pair.points);
        const LightTree& tree = cut_.tree();
        const dvec3 half = points.half();
        const bool in_lights =
            points.left == 0 || (!tree.is_leaf(pair.node) && tree.lights(pair.node).radius2() >= glm::dot(half, half));
        if (in_lights)
            for (const std::uint32_t child : {tree.left(pair.node), tree.right(pair.node)}) {
                const bool same = cut_.representative(child) == cut_.representative(pair.node);
                add(with_bound(child, pair.points, same ? pair.light : exchange(child, pair.points)));
            }
        else
            for (const std::uint32_t child : {points.left, points.right}) {
                const bool same = at(child).representative == points.representative;
                add(with_bound(pair.node, child, same ? pair.light : exchange(pair.node, child)));
            }
    }

private:
    const PointNode& at(std::uint32_t points) const { return (*nodes_)[points]; }

    Pair with_bound(std::uint32_t lights, std::uint32_t points, const Rgb& light) const {
        const PointNode& p = at(points);
        if (cut_.tree().is_leaf(lights) && p.left == 0)
            return {{lights, 0.0}, points, light};
        const NodeBound bound =
            bound_in_box(cut_.tree().lights(lights), scattering_, p.middle(), p.half(), p.extinction);
        return {{lights, p.weight * bound.largest()}, points, light};
    }

    Rgb exchange(std::uint32_t lights, std::uint32_t points) const {
        const GatherPoint& p = points_[at(points).representative];
        const float weight = luminance(p.weight);
        if (!(weight > 0.0f))
            return Rgb(0.0f);
        return p.weight / weight * lights_.estimate(cut_.representative(lights), 1.0, p.vertex, rng_);
    }

    const FireLights& lights_;
    const Lightcut& cut_;
    std::span<const GatherPoint> points_;
    Rng& rng_;
    ScatteringBound scattering_;  // the same for all points: one ray arrives at them
    const std::vector<PointNode>* nodes_;
};

}  // namespace

MultidimensionalLightcuts::MultidimensionalLightcuts(const FireLights& lights, const FireLightSettings& s)
    : lights_(lights), cut_(LightTree(lights.bounds()), s.seed, s.lightcuts_error, s.lightcuts_most) {}

Rgb MultidimensionalLightcuts::at(std::span<const GatherPoint> points, Rng& rng) const {
    if (cut_.tree().empty() || points.empty())
        return Rgb(0.0f);
    const Pairs pairs(lights_, cut_, points, rng);
    thread_local std::vector<Pair> cut;
    cut.assign(1, pairs.whole());
    return sum_of_cut(
        cut, cut_.error(), cut_.most(), [&](const Pair& pair) { return pairs.contribution(pair); },
        [&](const Pair& pair, const auto& add) { pairs.divide(pair, add); });
}

}  // namespace brisance
