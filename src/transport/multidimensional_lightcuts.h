// Multidimensional lightcuts: one cut through pairs of points on a camera ray and lights.
//
// B. Walter, A. Arbree, K. Bala, D. Greenberg, Multidimensional Lightcuts, SIGGRAPH 2006.
//
// The points of a ray are the leaves of a tree, as the lights are of theirs. A node of the cut is a pair of one node of
// each. Both have a representative, drawn in proportion to weight or intensity, and the pair contributes what these two
// exchange, times the ratios of weights and of intensities. It errs by at most W I M / d^2, with the largest phase
// function M over all directions from the box of the points to that of the lights and the least distance d between the
// boxes, or that at which the lights count as being however near they are (visibility counts as 1, and smoke as dense
// as where it is thinnest at the points, see gather_points.h). The pair that may err most is divided in the tree whose
// box is larger, until no pair may err by more than settings.lightcuts_error of the sum, or there are
// settings.lightcuts_most.
//
// Departs from the paper: the points are those of one ray, not of all rays of a pixel, as rays are integrated one by
// one; they are put in a tree by their order, without clustering; a point of a surface is alone, so that its cut is one
// through the lights (lightcuts.h); and the tree that is divided is chosen by size alone.
#pragma once

#include <algorithm>

#include "transport/gather_points.h"

namespace brisance {

// The points of one ray.
class PointTree {
public:
    // Some of them, one after another.
    struct Node {
        double weight = 0.0;  // luminance
        std::uint32_t representative = 0;
        std::uint32_t left = 0, right = 0;  // left == 0: a leaf
        dvec3 low{0.0}, high{0.0};
        double extinction = 0.0;  // the least at them [1/m]
        dvec3 middle() const { return 0.5 * (low + high); }
        dvec3 half() const { return 0.5 * (high - low); }
    };

    // At least one point. Overwrites the points before; reuse the tree to keep its memory.
    void build(std::span<const GatherPoint> points, Rng& rng) {
        nodes_.clear();
        build(points, 0, static_cast<std::uint32_t>(points.size()), rng);
    }
    const Node& operator[](std::uint32_t node) const { return nodes_[node]; }

private:
    std::uint32_t build(std::span<const GatherPoint> points, std::uint32_t begin, std::uint32_t end, Rng& rng) {
        const auto node = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
        if (end - begin == 1) {
            const dvec3& p = points[begin].vertex.position();
            nodes_[node] = {luminance(points[begin].weight), begin, 0, 0, p, p, points[begin].extinction};
            return node;
        }
        const std::uint32_t half = begin + (end - begin) / 2;
        const std::uint32_t left = build(points, begin, half, rng), right = build(points, half, end, rng);
        const Node &l = nodes_[left], &r = nodes_[right];
        const bool takes_left = rng.next_double() * (l.weight + r.weight) < l.weight;
        nodes_[node] = {
            l.weight + r.weight,      (takes_left ? l : r).representative, left, right, glm::min(l.low, r.low),
            glm::max(l.high, r.high), std::min(l.extinction, r.extinction)};
        return node;
    }

    std::vector<Node> nodes_;
};

template <class Lights>
class MultidimensionalLightcuts : public PointGatherer<typename Lights::Light> {
public:
    using Light = typename Lights::Light;
    template <class Settings>
    MultidimensionalLightcuts(const Lights& lights, const Settings& s)
        : lights_(lights),
          cut_(LightTree(lights.bounds(LobeBrightness::Peak)), s.seed, s.lightcuts_error, s.lightcuts_most,
               limits_of(lights, LobeBrightness::Peak)) {}

    Light at(std::span<const GatherPoint> points, Rng& rng) const override {
        if (cut_.tree().empty() || points.empty())
            return Light(Rgb(0.0f));
        if (points.size() == 1)
            return at_one(points[0], rng);
        thread_local PointTree tree;
        tree.build(points, rng);
        const Pairs pairs(*this, tree, points, rng);
        thread_local std::vector<Pair> cut;
        cut.assign(1, pairs.whole());
        return sum_of_cut(
            cut, cut_.error(), cut_.most(), [&](const Pair& pair) { return pairs.contribution(pair); },
            [&](const Pair& pair, const auto& add) { pairs.divide(pair, add); });
    }
    std::uint64_t bytes() const override { return cut_.bytes(); }

private:
    // CutNode::node is that of the lights.
    struct Pair : CutNode {
        std::uint32_t points = 0;
        Light light = Light(Rgb(0.0f));  // of one representative at the other, by the colour of the point's weight
    };

    class Pairs {
    public:
        Pairs(const MultidimensionalLightcuts& of, const PointTree& tree, std::span<const GatherPoint> points, Rng& rng)
            : lights_(of.lights_),
              cut_(of.cut_),
              tree_(tree),
              points_(points),
              rng_(rng),
              scattering_(points[0].vertex.bound()) {}

        Pair whole() const { return with_bound(0, 0, exchange(0, 0)); }

        Light contribution(const Pair& pair) const {
            return pair.light * float(tree_[pair.points].weight) * cut_.ratio_to_representative(pair.node);
        }

        // Of leaves only one is ever given that errs.
        template <class Add>
        void divide(const Pair& pair, const Add& add) const {
            const PointTree::Node& points = tree_[pair.points];
            const LightTree& lights = cut_.tree();
            const dvec3 half = points.half();
            const bool in_lights = points.left == 0 || (!lights.is_leaf(pair.node) &&
                                                        lights.lights(pair.node).radius2() >= glm::dot(half, half));
            if (in_lights)
                for (const std::uint32_t child : {lights.left(pair.node), lights.right(pair.node)}) {
                    const bool same = cut_.representative(child) == cut_.representative(pair.node);
                    add(with_bound(child, pair.points, same ? pair.light : exchange(child, pair.points)));
                }
            else
                for (const std::uint32_t child : {points.left, points.right}) {
                    const bool same = tree_[child].representative == points.representative;
                    add(with_bound(pair.node, child, same ? pair.light : exchange(pair.node, child)));
                }
        }

    private:
        Pair with_bound(std::uint32_t lights, std::uint32_t points, const Light& light) const {
            const PointTree::Node& p = tree_[points];
            if (cut_.tree().is_leaf(lights) && p.left == 0)
                return {{lights, 0.0}, points, light};
            NodeBound bound = bound_in_box(cut_.tree().lights(lights), scattering_, p.middle(), p.half(), p.extinction);
            bound.keep_off(cut_.least2(lights));
            return {{lights, p.weight * bound.largest()}, points, light};
        }

        Light exchange(std::uint32_t lights, std::uint32_t points) const {
            const GatherPoint& p = points_[tree_[points].representative];
            const float weight = luminance(p.weight);
            if (!(weight > 0.0f))
                return Light(Rgb(0.0f));
            return p.weight / weight * lights_.estimate(cut_.representative(lights), 1.0, p, rng_);
        }

        const Lights& lights_;
        const Lightcut& cut_;
        const PointTree& tree_;
        std::span<const GatherPoint> points_;
        Rng& rng_;
        ScatteringBound scattering_;  // the same for all points: one ray arrives at them
    };

    Light at_one(const GatherPoint& p, Rng& rng) const {
        return p.weight *
               cut_.at(
                   p.vertex, [&](std::size_t light) { return lights_.estimate(light, 1.0, p, rng); }, p.extinction);
    }

    const Lights& lights_;
    Lightcut cut_;
};

}  // namespace brisance
