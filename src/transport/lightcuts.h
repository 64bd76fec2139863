// Lightcuts: the lights of each node of a cut through a tree are lit by one of them that stands for all.
//
// B. Walter, S. Fernandez, A. Arbree, K. Bala, M. Donikian, D. Greenberg, Lightcuts: A Scalable Approach to
// Illumination, SIGGRAPH 2005.
//
// Every node of the tree has a representative light, drawn once, in proportion to intensity, from those of its two
// children. The contribution of a node is that of its representative times the ratio of intensities; it errs by at most
// M I / d^2, with the bounds of light_cut.h. The cut is divided where it may err most until no node may err by more
// than a part `error` of the sum, or it has `most` nodes. A child with its parent's representative takes over what that
// has contributed, so that its shadow ray is traced once.
//
// The choice of representatives is the same for all vertices: errors are correlated, and what one pixel errs is no
// noise. Its mean over trees drawn anew is right. Departs from the paper: the tree is that of light_tree.h, built from
// the top by orientation and area, not by clustering from below.
#pragma once

#include <type_traits>
#include <utility>

#include "transport/light_cut.h"

namespace brisance {

class Lightcut {
public:
    Lightcut(LightTree tree, std::uint32_t seed, double error, int most, const LightLimits& limits = {})
        : tree_(std::move(tree)),
          limits_(limits_of_nodes(tree_, limits)),
          representatives_(brisance::representatives(tree_, seed)),
          error_(error),
          most_(static_cast<std::size_t>(most)) {}

    // What the vertex scatters of all lights. light_of(light): of one of them, not weighted; Rgb or what adds up and
    // has a luminance() likewise. `extinction`: of smoke that bounds take to be all around the vertex [1/m]; then they
    // may be too low.
    template <class LightOf, class Light = std::invoke_result_t<const LightOf&, std::size_t>>
    Light at(const PathVertex& vertex, const LightOf& light_of, double extinction = 0.0) const {
        if (tree_.empty())
            return Light(Rgb(0.0f));
        const VertexBounds bounds(tree_, vertex, extinction, limits_);
        using Node = Represented<Light>;
        thread_local std::vector<Node> cut;
        cut.clear();
        const auto node_of = [&](std::uint32_t node, const NodeBound& bound, const Light& light) {
            return Node{{node, tree_.is_leaf(node) ? 0.0 : bound.largest()}, light};
        };
        if (const NodeBound root = bounds.of(0); root.scattered > 0.0)
            cut.push_back(node_of(0, root, light_of(representatives_[0])));
        return sum_of_cut(
            cut, error_, most_, [&](const Node& node) { return node.light * ratio_to_representative(node.node); },
            [&](const Node& divided, const auto& add) {
                for (const std::uint32_t child : {tree_.left(divided.node), tree_.right(divided.node)}) {
                    const NodeBound bound = bounds.of(child);
                    if (!(bound.scattered > 0.0))
                        continue;
                    const bool same = representatives_[child] == representatives_[divided.node];
                    add(node_of(child, bound, same ? divided.light : light_of(representatives_[child])));
                }
            });
    }

    const LightTree& tree() const { return tree_; }
    std::size_t representative(std::uint32_t node) const { return representatives_[node]; }
    // Of the intensity of all lights of a node to that of its representative.
    float ratio_to_representative(std::uint32_t node) const {
        const double one = tree_.lights(tree_.leaf(representatives_[node])).intensity();
        return one > 0.0 ? float(tree_.lights(node).intensity() / one) : 0.0f;
    }
    // At which the lights of a node count as being, however near they are (LightLimits) [m^2]; 0: without limits.
    double least2(std::uint32_t node) const { return limits_.empty() ? 0.0 : double(limits_[node].least2); }
    double error() const { return error_; }
    std::size_t most() const { return most_; }

    std::uint64_t bytes() const {
        return tree_.bytes() + representatives_.size() * sizeof(std::uint32_t) + limits_.size() * sizeof(NodeLimit);
    }

private:
    template <class Light>
    struct Represented : CutNode {
        Light light;  // the whole of the representative alone
    };

    LightTree tree_;
    std::vector<NodeLimit> limits_;
    std::vector<std::uint32_t> representatives_;
    double error_;
    std::size_t most_;
};

}  // namespace brisance
