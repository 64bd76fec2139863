#include "emitters/light_front.h"

#include <algorithm>
#include <queue>

namespace brisance {

namespace {

// Of choices, the share by intensity and distance alone: lights that do not reach the middle may reach others.
constexpr double kShareOfAll = 0.05;

double by_distance(const LightCone& lights, const dvec3& from) {
    return lights.intensity() / std::max({lights.seen_from(from).nearest2, lights.radius2(), 1e-300});
}

struct Candidate {
    double importance;
    std::uint32_t node;
    bool operator<(const Candidate& o) const {
        return importance != o.importance ? importance < o.importance : node > o.node;
    }
};

// The nodes that remain when those of the largest importance are divided.
std::vector<std::uint32_t> divided(const LightTree& tree, const LitPoint& middle, std::size_t most) {
    std::vector<std::uint32_t> leaves;
    std::priority_queue<Candidate> open;
    const auto add = [&](std::uint32_t node) {
        if (tree.is_leaf(node))
            leaves.push_back(node);
        else
            open.push({tree.lights(node).importance(middle), node});
    };
    add(0);
    while (!open.empty() && leaves.size() + open.size() < most) {
        const std::uint32_t node = open.top().node;
        open.pop();
        add(tree.left(node));
        add(tree.right(node));
    }
    for (; !open.empty(); open.pop())
        leaves.push_back(open.top().node);
    std::sort(leaves.begin(), leaves.end());  // nodes that are neighbours in the tree are neighbours in the list
    return leaves;
}

}  // namespace

LightFront::LightFront(const LightTree& tree, const LitPoint& middle, std::size_t most) : tree_(tree) {
    if (tree.empty())
        return;
    nodes_ = divided(tree, middle, most);
    std::vector<double> reaching, all;
    double sum_reaching = 0.0, sum_all = 0.0, passed = 0.0;
    for (const std::uint32_t node : nodes_) {
        reaching.push_back(tree.lights(node).importance(middle));
        all.push_back(by_distance(tree.lights(node), middle.position));
        sum_reaching += reaching.back();
        sum_all += all.back();
    }
    if (!(sum_all > 0.0))
        return;
    const double share_of_all = sum_reaching > 0.0 ? kShareOfAll : 1.0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        passed += share_of_all * all[i] / sum_all;
        if (sum_reaching > 0.0)
            passed += (1.0 - share_of_all) * reaching[i] / sum_reaching;
        passed_.push_back(passed);
    }
}

std::optional<LightTree::Choice> LightFront::choose(const LitPoint& point, double u) const {
    if (passed_.empty())
        return std::nullopt;
    const double goal = u * passed_.back();
    const auto found = std::upper_bound(passed_.begin(), passed_.end() - 1, goal);
    const auto at = static_cast<std::size_t>(found - passed_.begin());
    const double before = at > 0 ? passed_[at - 1] : 0.0, width = passed_[at] - before;
    if (!(width > 0.0))
        return std::nullopt;
    const double inside = std::clamp((goal - before) / width, 0.0, 1.0 - 0x1p-53);
    const auto light = tree_.choose_from(nodes_[at], point, inside);
    if (!light)
        return std::nullopt;
    return LightTree::Choice{light->light, light->probability * width / passed_.back()};
}

}  // namespace brisance
