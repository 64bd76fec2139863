#include "elimination/kd_order.h"

#include <algorithm>

#include "core/parallel.h"

namespace brisance {

namespace {

struct Item {
    vec3 point;
    std::uint32_t index;
};

struct Range {
    std::size_t begin, end;
    std::size_t size() const { return end - begin; }
};

constexpr std::size_t kSerial = 16384;  // points that one task sorts to the end

int longest_side(const Item* items, std::size_t n) {
    vec3 low = items[0].point, high = low;
    for (std::size_t i = 1; i < n; ++i) {
        low = glm::min(low, items[i].point);
        high = glm::max(high, items[i].point);
    }
    const vec3 side = high - low;
    return side.x >= side.y ? (side.x >= side.z ? 0 : 2) : (side.y >= side.z ? 1 : 2);
}

// Returns the number of items in the lower half.
std::size_t split(Item* items, std::size_t n) {
    const int axis = longest_side(items, n);
    const std::size_t half = kLeafSize * lower_leaves((n + kLeafSize - 1) / kLeafSize);
    std::nth_element(items, items + half, items + n, [axis](const Item& a, const Item& b) {
        return a.point[axis] < b.point[axis] || (a.point[axis] == b.point[axis] && a.index < b.index);
    });
    return half;
}

void sort_range(Item* items, std::size_t n) {
    if (n <= kLeafSize)
        return;
    const std::size_t half = split(items, n);
    sort_range(items, half);
    sort_range(items + half, n - half);
}

// The ranges of the next level; those small enough are sorted to the end.
std::vector<Range> split_level(std::vector<Item>& items, const std::vector<Range>& ranges) {
    std::vector<std::size_t> middle(ranges.size());
    parallel_for(ranges.size(), [&](std::size_t r) {
        Item* first = items.data() + ranges[r].begin;
        if (ranges[r].size() <= kSerial)
            sort_range(first, ranges[r].size());
        else
            middle[r] = ranges[r].begin + split(first, ranges[r].size());
    });
    std::vector<Range> next;
    for (std::size_t r = 0; r < ranges.size(); ++r)
        if (ranges[r].size() > kSerial) {
            next.push_back({ranges[r].begin, middle[r]});
            next.push_back({middle[r], ranges[r].end});
        }
    return next;
}

}  // namespace

std::vector<std::uint32_t> kd_order(std::span<const vec3> points) {
    std::vector<Item> items(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        items[i] = {points[i], static_cast<std::uint32_t>(i)};
    std::vector<Range> ranges{{0, points.size()}};
    while (!ranges.empty())
        ranges = split_level(items, ranges);
    std::vector<std::uint32_t> order(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        order[i] = items[i].index;
    return order;
}

}  // namespace brisance
