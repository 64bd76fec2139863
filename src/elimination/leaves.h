// Points in leaves of sixteen, with boxes over them that show which leaves may hold neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "elimination/kd_order.h"
#include "elimination/weight.h"

namespace brisance {

// Candidates in k-d order; lengths in any unit.
struct Candidates {
    std::vector<vec3> position;
    std::vector<float> reach;         // d_max: others nearer than this add to the point's weight
    std::vector<std::uint32_t> rank;  // breaks ties: of equal weights the greater rank goes first

    std::size_t size() const { return position.size(); }
};

// Sixteen slots for points. Empty slots, whether unused or eliminated, lie too far away to be a neighbour and weigh -1.
struct alignas(64) Leaf {
    float x[kLeafSize], y[kLeafSize], z[kLeafSize];
    float inverse_reach[kLeafSize];  // 1 / d_max
    std::uint32_t rank[kLeafSize];
    Weight weight[kLeafSize];

    void clear(std::size_t slot);
    void set(std::size_t slot, const vec3& position, float inverse_reach, std::uint32_t rank, Weight weight);
};

struct LeafBox {
    vec3 low{0.0f}, high{0.0f};
    float reach = 0.0f;  // the greatest of the points inside
};

// Boxes over leaves and over pairs of boxes, as a binary heap.
class LeafTree {
public:
    LeafTree() = default;
    explicit LeafTree(std::vector<LeafBox> leaves);

    // Finds all leaves, the box's own included, that may hold a point nearer to a point of `box` than `reach` or than
    // its own reach.
    void find(const LeafBox& box, std::vector<std::uint32_t>& found) const;

    const LeafBox& leaf(std::size_t l) const { return leaves_[l]; }
    std::size_t size() const { return leaves_.size(); }

private:
    const LeafBox& build(std::size_t node, std::size_t begin, std::size_t end);
    void find(const LeafBox& box, std::size_t node, std::size_t begin, std::size_t end,
              std::vector<std::uint32_t>& found) const;

    std::vector<LeafBox> leaves_, nodes_;
};

// Makes leaf l of the chosen candidates, taken sixteen by sixteen in the order given, with every reach multiplied by
// `scale` and zero weights.
Leaf make_leaf(const Candidates& candidates, std::span<const std::uint32_t> chosen, std::size_t l, float scale);

// The boxes of all leaves.
LeafTree boxes_around(const Candidates& candidates, std::span<const std::uint32_t> chosen, float scale);

}  // namespace brisance
