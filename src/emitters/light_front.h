// Chooses lights of a tree for points that lie close together.
//
// From the root down, a choice evaluates two bounds at every branch (light_tree.h). Most of these branches lie so far
// away that they look alike from all the points. A front of nodes is therefore found once, for one of the points, with
// the probability of each: a choice then searches a list of sums and descends from there only.
#pragma once

#include <vector>

#include "emitters/light_tree.h"

namespace brisance {

class LightFront {
public:
    // Of at most `most` nodes, the most important ones divided first. Keeps a reference to the tree.
    LightFront(const LightTree& tree, const LitPoint& middle, std::size_t most);

    // Chooses by a number in [0, 1), for a point near `middle`. None where no light can reach the point. Every light
    // that reaches a point has a probability there, whether or not it reaches `middle`.
    std::optional<LightTree::Choice> choose(const LitPoint& point, double u) const;

private:
    const LightTree& tree_;
    std::vector<std::uint32_t> nodes_;
    std::vector<double> passed_;  // running sum of probabilities
};

}  // namespace brisance
