// Lightcuts: the lights of each node of a cut through a tree are lit by one of them that stands for all.
//
// B. Walter, S. Fernandez, A. Arbree, K. Bala, M. Donikian, D. Greenberg, Lightcuts: A Scalable Approach to
// Illumination, SIGGRAPH 2005.
//
// Every node of the tree has a representative light, drawn once, in proportion to intensity, from those of its two
// children. The contribution of a node is that of its representative times the ratio of intensities; it errs by at most
// M I / d^2, with the bounds of light_cut.h. The cut is divided where it may err most until no node may err by more
// than settings.lightcuts_error of the sum, or it has settings.lightcuts_most nodes. A child with its parent's
// representative takes over what that has contributed, so that its shadow ray is traced once.
//
// The choice of representatives is the same for all vertices: errors are correlated, and what one pixel errs is no
// noise. Its mean over trees drawn anew is right. Departs from the paper: the tree is that of light_tree.h, built from
// the top by orientation and area, not by clustering from below.
#pragma once

#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/light_choosers.h"
#include "virtual_lights/gatherers/light_cut.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

// For every node of the tree a light of it, drawn in proportion to intensity.
std::vector<std::uint32_t> representatives(const LightTree& tree, std::uint32_t seed);

struct Lightcuts {
    static constexpr const char* kNeeds = "any kind of light";

    template <VirtualLightKind Kind>
    class Of : public Gatherer {
    public:
        Of(const LightSet& set, LightImportance)
            : kind_(set),
              lights_(set.lights),
              tree_(bounds_of(set.lights, LobeBrightness::Peak)),
              representatives_(representatives(tree_, set.settings().seed)),
              error_(set.settings().lightcuts_error),
              most_(static_cast<std::size_t>(set.settings().lightcuts_most)) {}

        Rgb from_lights(const PathVertex& vertex, Rng& rng) const override {
            if (tree_.empty())
                return Rgb(0.0f);
            const VertexBounds bounds(tree_, vertex);
            thread_local std::vector<Represented> cut;
            cut.clear();
            double sum = 0.0;
            const auto with_bound = [&](std::uint32_t node, const NodeBound& bound, const Rgb& light) {
                Represented out{{node, tree_.is_leaf(node) ? 0.0 : bound.largest()}, light};
                sum += luminance(contribution(out));
                return out;
            };
            if (const NodeBound root = bounds.of(0); root.scattered > 0.0)
                cut.push_back(with_bound(0, root, of_representative(0, vertex, rng)));
            refine_cut(
                cut, most_, [&](double error) { return error <= error_ * sum; },
                [&](const Represented& divided, const auto& add) {
                    sum -= luminance(contribution(divided));
                    for (const std::uint32_t child : {tree_.left(divided.node), tree_.right(divided.node)}) {
                        const NodeBound bound = bounds.of(child);
                        if (!(bound.scattered > 0.0))
                            continue;
                        const bool same = representatives_[child] == representatives_[divided.node];
                        add(with_bound(child, bound, same ? divided.light : of_representative(child, vertex, rng)));
                    }
                });
            Rgb total(0.0f);
            for (const Represented& node : cut)
                total += contribution(node);
            return total;
        }

        std::uint64_t bytes() const override { return tree_.bytes() + representatives_.size() * sizeof(std::uint32_t); }

    private:
        struct Represented : CutNode {
            Rgb light{0.0f};  // the whole of the representative alone
        };

        Rgb of_representative(std::uint32_t node, const PathVertex& vertex, Rng& rng) const {
            return kind_.estimate(representatives_[node], 1.0, vertex, rng);
        }

        Rgb contribution(const Represented& node) const {
            const double one = lights_[representatives_[node.node]].intensity;
            return one > 0.0 ? node.light * float(tree_.lights(node.node).intensity() / one) : Rgb(0.0f);
        }

        Kind kind_;
        const std::vector<VirtualLight>& lights_;
        LightTree tree_;
        std::vector<std::uint32_t> representatives_;
        double error_;
        std::size_t most_;
    };
};

}  // namespace brisance
