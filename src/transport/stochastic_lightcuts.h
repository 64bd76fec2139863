// Stochastic lightcuts: a cut of fixed size, and one random light of each of its nodes.
//
// [1] C. Yuksel, Stochastic Lightcuts, HPG 2019; Stochastic Lightcuts for Sampling Many Lights, IEEE TVCG 27(10), 2021.
// [2] D. Lin, C. Yuksel, Real-Time Stochastic Lightcuts, I3D 2020: the probabilities of the descent.
//
// From each node of the cut a random walk goes down to one light. At every branch with bounds M on what is scattered,
//     w = M / d^2,  P(left) = (w_l / (w_l + w_r) for the nearest distances + the same for the farthest) / 2,
// so that nothing is favoured by the bounds of a box around the vertex. There are no representative lights, and
// neighbouring pixels share no error. Any kind of light will do: the light that is found is sampled as a whole.
//
// Departs from [1]: the tree is that of light_tree.h, built from the top by orientation and area, instead of from
// below or along Morton's curve.
#pragma once

#include <type_traits>
#include <utility>

#include "core/rng.h"
#include "transport/light_cut.h"

namespace brisance {

class StochasticLightcut {
public:
    // `size`: nodes of a cut.
    StochasticLightcut(LightTree tree, int size, const LightLimits& limits = {})
        : tree_(std::move(tree)), limits_(limits_of_nodes(tree_, limits)), size_(size) {}

    // What the vertex scatters of all lights. estimate(light, probability): of one that is chosen so, weighted;
    // Rgb or what adds up likewise. `extinction`: of smoke that is taken to be all around the vertex [1/m].
    template <class Estimate, class Light = std::invoke_result_t<const Estimate&, std::size_t, double>>
    Light at(const PathVertex& vertex, Rng& rng, const Estimate& estimate, double extinction = 0.0) const {
        if (tree_.empty())
            return Light(Rgb(0.0f));
        const VertexBounds bounds(tree_, vertex, extinction, limits_);
        thread_local std::vector<CutNode> cut;
        cut.assign(1, {0, tree_.is_leaf(0) ? 0.0 : bounds.of(0).largest()});
        refine_cut(
            cut, static_cast<std::size_t>(size_), [](double) { return false; },
            [&](const CutNode& divided, const auto& add) {
                for (const std::uint32_t child : {tree_.left(divided.node), tree_.right(divided.node)})
                    if (const double largest = bounds.of(child).largest(); largest > 0.0)
                        add({child, tree_.is_leaf(child) ? 0.0 : largest});
            });
        auto sum = Light(Rgb(0.0f));
        for (const CutNode& node : cut) {
            const std::optional<LightTree::Choice> choice =
                tree_.choose_below(node.node, rng.next_double(), [&](std::uint32_t left, std::uint32_t right) {
                    return share_by_distances(bounds.of(left), bounds.of(right));
                });
            if (choice)
                sum += estimate(choice->light, choice->probability);
        }
        return sum;
    }

    std::uint64_t bytes() const { return tree_.bytes() + limits_.size() * sizeof(NodeLimit); }

private:
    LightTree tree_;
    std::vector<NodeLimit> limits_;
    int size_;
};

}  // namespace brisance
