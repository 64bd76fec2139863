#include "elimination/leaves.h"

#include <algorithm>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr float kFar = 1e18f;  // squares still fit a float
constexpr std::size_t kLeafGrain = 512;

float square_gap(const LeafBox& a, const LeafBox& b) {
    const vec3 gap = glm::max(glm::max(a.low - b.high, b.low - a.high), vec3(0.0f));
    return glm::dot(gap, gap);
}

// A margin for the rounding of distances on either side.
bool in_reach(const LeafBox& a, const LeafBox& b) {
    const float reach = std::max(a.reach, b.reach) * 1.000001f;
    return square_gap(a, b) <= reach * reach;
}

LeafBox around(const LeafBox& a, const LeafBox& b) {
    return {glm::min(a.low, b.low), glm::max(a.high, b.high), std::max(a.reach, b.reach)};
}

std::size_t leaf_count(std::size_t points) {
    return (points + kLeafSize - 1) / kLeafSize;
}

}  // namespace

void Leaf::clear(std::size_t slot) {
    set(slot, vec3(kFar), 1.0f, 0, -1);
}

void Leaf::set(std::size_t slot, const vec3& position, float inverse, std::uint32_t its_rank, Weight its_weight) {
    x[slot] = position.x;
    y[slot] = position.y;
    z[slot] = position.z;
    inverse_reach[slot] = inverse;
    rank[slot] = its_rank;
    weight[slot] = its_weight;
}

LeafTree::LeafTree(std::vector<LeafBox> leaves) : leaves_(std::move(leaves)) {
    std::size_t heap = 1;
    while (heap < leaves_.size())
        heap *= 2;
    nodes_.resize(heap);  // of two leaves or more
    if (!leaves_.empty())
        build(1, 0, leaves_.size());
}

const LeafBox& LeafTree::build(std::size_t node, std::size_t begin, std::size_t end) {
    if (end - begin == 1)
        return leaves_[begin];
    const std::size_t middle = begin + lower_leaves(end - begin);
    return nodes_[node] = around(build(2 * node, begin, middle), build(2 * node + 1, middle, end));
}

void LeafTree::find(const LeafBox& box, std::vector<std::uint32_t>& found) const {
    found.clear();
    if (!leaves_.empty())
        find(box, 1, 0, leaves_.size(), found);
}

void LeafTree::find(const LeafBox& box, std::size_t node, std::size_t begin, std::size_t end,
                    std::vector<std::uint32_t>& found) const {
    const bool single = end - begin == 1;
    if (!in_reach(box, single ? leaves_[begin] : nodes_[node]))
        return;
    if (single) {
        found.push_back(static_cast<std::uint32_t>(begin));
        return;
    }
    const std::size_t middle = begin + lower_leaves(end - begin);
    find(box, 2 * node, begin, middle, found);
    find(box, 2 * node + 1, middle, end, found);
}

Leaf make_leaf(const Candidates& candidates, std::span<const std::uint32_t> chosen, std::size_t l, float scale) {
    Leaf leaf;
    for (std::size_t s = 0; s < kLeafSize; ++s) {
        const std::size_t k = l * kLeafSize + s;
        if (k < chosen.size()) {
            const std::uint32_t i = chosen[k];
            leaf.set(s, candidates.position[i], inverse_reach(candidates.reach[i], scale), candidates.rank[i], 0);
        } else {
            leaf.clear(s);
        }
    }
    return leaf;
}

LeafTree boxes_around(const Candidates& candidates, std::span<const std::uint32_t> chosen, float scale) {
    std::vector<LeafBox> boxes(leaf_count(chosen.size()));
    parallel_for(
        boxes.size(),
        [&](std::size_t l) {
            const std::size_t end = std::min(chosen.size(), (l + 1) * kLeafSize);
            LeafBox box{candidates.position[chosen[l * kLeafSize]], candidates.position[chosen[l * kLeafSize]], 0.0f};
            for (std::size_t k = l * kLeafSize; k < end; ++k) {
                const vec3& p = candidates.position[chosen[k]];
                box = around(box, {p, p, candidates.reach[chosen[k]] * scale});
            }
            boxes[l] = box;
        },
        kLeafGrain);
    return LeafTree(std::move(boxes));
}

}  // namespace brisance
