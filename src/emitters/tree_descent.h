// Descends from the root of a binary tree of lights to one of them, and back, by probabilities at every branch.
//
// Nodes have `parent`, `left` and `right`; left == 0 is a leaf. `share_of_left(node)`: probability of the left branch,
// below 0 where neither branch has any.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace brisance {

struct TreeDescent {
    std::uint32_t leaf = 0;
    double probability = 1.0;
    int branches = 0;  // visited
};

// `u` in [0, 1): neighbouring numbers find neighbouring leaves. `from`: the node where it starts.
template <class Node, class ShareOfLeft>
std::optional<TreeDescent> descend(const std::vector<Node>& nodes, double u, const ShareOfLeft& share_of_left,
                                   std::uint32_t from = 0) {
    TreeDescent at{from};
    while (nodes[at.leaf].left != 0) {
        const double left = share_of_left(nodes[at.leaf]);
        if (left < 0.0)
            return std::nullopt;
        const bool goes_left = u < left;
        const double share = goes_left ? left : 1.0 - left;
        u = std::min((goes_left ? u : u - left) / share, 1.0 - 0x1p-53);
        at.probability *= share;
        ++at.branches;
        at.leaf = goes_left ? nodes[at.leaf].left : nodes[at.leaf].right;
    }
    return at;
}

// The probability with which descend() finds the leaf.
template <class Node, class ShareOfLeft>
double descent_probability(const std::vector<Node>& nodes, std::uint32_t leaf, const ShareOfLeft& share_of_left) {
    double probability = 1.0;
    for (std::uint32_t at = leaf; at != 0; at = nodes[at].parent) {
        const Node& parent = nodes[nodes[at].parent];
        const double left = share_of_left(parent);
        if (left < 0.0)
            return 0.0;
        probability *= parent.left == at ? left : 1.0 - left;
    }
    return probability;
}

}  // namespace brisance
