// A balanced tree of axis-aligned boxes around primitives. The order in which it visits them depends on the boxes
// alone: sums over what is found are the same for any number of threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/vec.h"
#include "tracking/segment.h"

namespace brisance {

struct Box {
    vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
    void include(const vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void include(const Box& b) {
        low = glm::min(low, b.low);
        high = glm::max(high, b.high);
    }
};

class BoxTree {
public:
    BoxTree() = default;
    explicit BoxTree(const std::vector<Box>& boxes);

    // The primitives in the tree's order, which find() counts by.
    const std::vector<std::uint32_t>& order() const { return order_; }

    // Calls visit(k) for all primitives of every leaf whose box meets(box); `meets` must hold for a box that contains
    // another for which it holds.
    template <class Meets, class Visit>
    void find(const Meets& meets, const Visit& visit) const;

    std::uint64_t bytes() const { return order_.size() * sizeof(std::uint32_t) + boxes_.size() * sizeof(Box); }

private:
    static constexpr int kLeaf = 8;  // primitives, about
    std::size_t first_of(std::size_t part, int depth) const { return (order_.size() * part) >> depth; }
    void split(std::size_t part, int depth, const std::vector<Box>& boxes);

    int depth_ = 0;
    std::vector<std::uint32_t> order_;
    std::vector<Box> boxes_;  // the children of node i are 2 i and 2 i + 1; the root is 1
};

// Whether a segment passes within a distance of a box, with boxes rounded off by their enclosing boxes.
class SegmentNearBox {
public:
    SegmentNearBox(const Segment& segment, double radius);
    bool operator()(const Box& box) const {
        double begin = 0.0, end = length_;
        for (int a = 0; a < 3; ++a) {
            const double x = (double(box.low[a]) - radius_ - start_[a]) * inverse_[a],
                         y = (double(box.high[a]) + radius_ - start_[a]) * inverse_[a];
            begin = std::max(begin, std::min(x, y));
            end = std::min(end, std::max(x, y));
        }
        return begin <= end;
    }

private:
    dvec3 start_, inverse_;
    double length_, radius_;
};

template <class Meets, class Visit>
void BoxTree::find(const Meets& meets, const Visit& visit) const {
    if (order_.empty() || !meets(boxes_[1]))
        return;
    const std::size_t leaves = std::size_t(1) << depth_;
    std::size_t stack[64];
    int waiting = 0;
    stack[waiting++] = 1;
    while (waiting > 0) {
        const std::size_t node = stack[--waiting];
        if (node >= leaves) {
            for (std::size_t k = first_of(node - leaves, depth_); k < first_of(node - leaves + 1, depth_); ++k)
                visit(k);
            continue;
        }
        for (const std::size_t child : {2 * node + 1, 2 * node})
            if (meets(boxes_[child]))
                stack[waiting++] = child;
    }
}

}  // namespace brisance
