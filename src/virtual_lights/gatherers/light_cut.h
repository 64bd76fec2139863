// Cuts through a light tree: nodes that together hold every light which can reach a vertex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "emitters/light_tree.h"
#include "transport/path_vertex.h"

namespace brisance {

// What the lights of one node can send to a vertex, between bounds.
struct NodeBound {
    double scattered = 0.0;                  // bound on intensity times BSDF and cosine, luminance [W/sr^2]
    double nearest2 = 0.0, farthest2 = 0.0;  // squared distances to their box [m^2]

    // Upper bound on what the vertex scatters of them without occlusion [W/(m^2 sr)]. It is finite also inside their
    // box: lights count as no nearer than a thousandth of the farthest distance.
    double largest() const {
        constexpr double kLeast = 1e-6;
        return scattered > 0.0 ? scattered / std::max({nearest2, kLeast * farthest2, 1e-300}) : 0.0;
    }
};

// The bounds of all nodes for one vertex.
class VertexBounds {
public:
    // Keeps references.
    VertexBounds(const LightTree& tree, const PathVertex& vertex)
        : tree_(tree), vertex_(vertex), bsdf_(vertex.bound()) {}

    NodeBound of(std::uint32_t node) const {
        const LightsInView view = tree_.lights(node).seen_from(vertex_.position());
        NodeBound out{0.0, view.nearest2, view.farthest2};
        if (view.intensity > 0.0)
            out.scattered = view.intensity * bsdf_.over(view.direction, view.cos_around);
        return out;
    }

private:
    const LightTree& tree_;
    const PathVertex& vertex_;
    ScatteringBound bsdf_;
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

}  // namespace brisance
