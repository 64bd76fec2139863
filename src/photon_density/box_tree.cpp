#include "photon_density/box_tree.h"

#include <cmath>
#include <numeric>

#include "core/parallel.h"

namespace brisance {

namespace {

// Components of directions smaller than this count as such: over any distance they move a ray by less than rounding.
constexpr double kLeastComponent = 1e-18;

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
    if (boxes.empty())
        return;
    std::iota(order_.begin(), order_.end(), 0u);
    while ((boxes.size() >> depth_) > std::size_t(kLeaf))
        ++depth_;
    for (int d = 0; d < depth_; ++d)
        parallel_for(std::size_t(1) << d, [&](std::size_t part) { split(part, d, boxes); });
    const std::size_t leaves = std::size_t(1) << depth_;
    boxes_.resize(2 * leaves);
    parallel_for(
        leaves,
        [&](std::size_t leaf) {
            for (std::size_t k = first_of(leaf, depth_); k < first_of(leaf + 1, depth_); ++k)
                boxes_[leaves + leaf].include(boxes[order_[k]]);
        },
        64);
    for (std::size_t node = leaves; --node >= 1;) {
        boxes_[node] = boxes_[2 * node];
        boxes_[node].include(boxes_[2 * node + 1]);
    }
}

// At the median of the boxes' centres, along the axis in which they are spread most; ties go by number.
void BoxTree::split(std::size_t part, int depth, const std::vector<Box>& boxes) {
    const auto begin = order_.begin() + std::ptrdiff_t(first_of(part, depth)),
               end = order_.begin() + std::ptrdiff_t(first_of(part + 1, depth)),
               middle = order_.begin() + std::ptrdiff_t(first_of(2 * part + 1, depth + 1));
    const auto centre = [&](std::uint32_t i) { return 0.5f * boxes[i].low + 0.5f * boxes[i].high; };
    Box centres;
    for (auto i = begin; i != end; ++i)
        centres.include(centre(*i));
    const vec3 spread = centres.high - centres.low;
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : (spread.y >= spread.z ? 1 : 2);
    std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
        const float x = centre(a)[axis], y = centre(b)[axis];
        return x != y ? x < y : a < b;
    });
}

SegmentNearBox::SegmentNearBox(const Segment& segment, double radius)
    : start_(segment.start), length_(segment.length), radius_(radius) {
    for (int a = 0; a < 3; ++a) {
        const double d = segment.direction[a];
        inverse_[a] = 1.0 / (std::abs(d) < kLeastComponent ? std::copysign(kLeastComponent, d) : d);
    }
}

}  // namespace brisance
