// Cuts through a light tree: nodes that together hold every light which can reach a vertex. Whatever kind of light is
// in the tree, its owner says what a vertex scatters of one light (lightcuts.h, stochastic_lightcuts.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "emitters/light_tree.h"
#include "light_selection/medium_light_tree.h"
#include "transport/path_vertex.h"

namespace brisance {

// What the lights of one node can send to a vertex, between bounds.
struct NodeBound {
    double scattered = 0.0;                  // bound on intensity times BSDF and cosine, luminance [W/sr^2]
    double nearest2 = 0.0, farthest2 = 0.0;  // squared distances to their box [m^2]
    // Of smoke that is taken to be everywhere between them [1/m]; 0: none, so that the bounds hold.
    double extinction = 0.0;

    // `scattered` after such a squared distance.
    double dimmed(double distance2) const {
        return extinction > 0.0 ? scattered * guessed_transmittance(extinction * std::sqrt(distance2)) : scattered;
    }

    // For lights that are bounded nearby as if they were no nearer than that [m^2].
    void keep_off(double least2) {
        nearest2 = std::max(nearest2, least2);
        farthest2 = std::max(farthest2, nearest2);
    }

    // Upper bound on what the vertex scatters of them without occlusion [W/(m^2 sr)]. It is finite also inside their
    // box: lights count as no nearer than a thousandth of the farthest distance.
    double largest() const {
        constexpr double kLeast = 1e-6;
        return scattered > 0.0 ? dimmed(nearest2) / std::max({nearest2, kLeast * farthest2, 1e-300}) : 0.0;
    }
};

// For all points of a box with that middle and half that size [m]. `extinction`: of the smoke around them.
inline NodeBound bound_in_box(const LightCone& lights, const ScatteringBound& scattering, const dvec3& middle,
                              const dvec3& half, double extinction) {
    const LightsInView view = lights.seen_from(middle, half);
    NodeBound out{0.0, view.nearest2, view.farthest2, extinction};
    if (view.intensity > 0.0)
        out.scattered = view.intensity * scattering.over(view.direction, view.cos_around);
    return out;
}

// Beside a tree: nodes around a vertex have no other bound, and lights of the surface that it lies on would get all of
// a small cut.
struct LightLimits {
    std::vector<LightBounds> bounds;  // of each light
    // At which each light counts as being, however near it is: it sends its intensity over that at most [m^2].
    std::vector<double> least2;
};

// The same for a node. Its lights together send at most the sum of I / least2, which is its I over its own least2.
struct NodeLimit {
    dvec3 middle{0.0}, half{0.0};  // of the box of its lights [m]
    float least2 = 0.0f;
    bool far = false;  // lights at infinity are among them

    // How far they reach above a plane at most [m].
    double height(const dvec3& point, const dvec3& normal) const {
        return glm::dot(normal, middle - point) + glm::dot(glm::abs(normal), half);
    }
};

// For every node; none without limits.
std::vector<NodeLimit> limits_of_nodes(const LightTree& tree, const LightLimits& of_lights);

// The bounds of all nodes for one vertex.
class VertexBounds {
public:
    // Keeps references. `limits`: limits_of_nodes(), or empty.
    VertexBounds(const LightTree& tree, const PathVertex& vertex, double extinction,
                 std::span<const NodeLimit> limits = {})
        : tree_(tree), vertex_(vertex), bsdf_(vertex.bound()), extinction_(extinction), limits_(limits) {}

    NodeBound of(std::uint32_t node) const {
        const LightsInView view = tree_.lights(node).seen_from(vertex_.position());
        NodeBound out{0.0, view.nearest2, view.farthest2, extinction_};
        if (!(view.intensity > 0.0))
            return out;
        const double most_cosine = limits_.empty() ? 1.0 : largest_cosine(limits_[node], view);
        out.scattered = view.intensity * bsdf_.over(view.direction, view.cos_around, most_cosine);
        if (!limits_.empty())
            out.keep_off(limits_[node].least2);
        return out;
    }

private:
    double largest_cosine(const NodeLimit& limit, const LightsInView& view) const;

    const LightTree& tree_;
    const PathVertex& vertex_;
    ScatteringBound bsdf_;
    double extinction_;
    std::span<const NodeLimit> limits_;
};

// One node of a cut. A cut is a heap: the node whose lights may err most stands first. Leaves do not err.
struct CutNode {
    std::uint32_t node = 0;
    double error = 0.0;  // bound
};

inline bool errs_less(const CutNode& a, const CutNode& b) {
    return a.error != b.error ? a.error < b.error : a.node > b.node;
}

// Divides the node that may err most, until the cut has `most` nodes, only leaves are left, or enough(error) holds for
// the node that may err most. replace(node, add): add(child) for the children to keep.
template <class Node, class Enough, class Replace>
void refine_cut(std::vector<Node>& cut, std::size_t most, const Enough& enough, const Replace& replace) {
    while (!cut.empty() && cut.size() < most && cut.front().error > 0.0 && !enough(cut.front().error)) {
        std::pop_heap(cut.begin(), cut.end(), errs_less);
        const Node divided = cut.back();
        cut.pop_back();
        replace(divided, [&](const Node& child) {
            cut.push_back(child);
            std::push_heap(cut.begin(), cut.end(), errs_less);
        });
    }
}

// The light of all nodes of a cut, which is divided until no node may err by more than `error` of the sum, or it has
// `most` nodes. contribution(node): has a luminance(); divide(node, add) as replace() above.
template <class Node, class Contribution, class Divide>
auto sum_of_cut(std::vector<Node>& cut, double error, std::size_t most, const Contribution& contribution,
                const Divide& divide) {
    double sum = 0.0;
    for (const Node& node : cut)
        sum += luminance(contribution(node));
    refine_cut(
        cut, most, [&](double largest) { return largest <= error * sum; },
        [&](const Node& divided, const auto& add) {
            sum -= luminance(contribution(divided));
            divide(divided, [&](const Node& child) {
                sum += luminance(contribution(child));
                add(child);
            });
        });
    auto total = decltype(contribution(cut.front()))(Rgb(0.0f));
    for (const Node& node : cut)
        total += contribution(node);
    return total;
}

// For every node of the tree a light of it, drawn in proportion to intensity.
std::vector<std::uint32_t> representatives(const LightTree& tree, std::uint32_t seed);

// Probability of the left of two nodes; below 0 where neither has any.
double share_by_distances(const NodeBound& left, const NodeBound& right);

}  // namespace brisance
