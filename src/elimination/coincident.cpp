#include "elimination/coincident.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

namespace brisance {

namespace {

struct IndexedPoint {
    vec3 point;
    std::uint32_t index;

    auto key() const { return std::tie(point.x, point.y, point.z, index); }
};

std::uint64_t hash(const vec3& p) {
    std::uint64_t h = 0;
    for (int a = 0; a < 3; ++a) {
        h = (h ^ std::bit_cast<std::uint32_t>(p[a] + 0.0f)) * 0x9e3779b97f4a7c15;  // -0 is 0
        h ^= h >> 32;
    }
    return h;
}

}  // namespace

// Most points have the bit that their hash selects to themselves. Only the few others are sorted.
std::vector<std::uint32_t> first_coincident(std::span<const vec3> points) {
    const std::uint64_t mask = std::bit_ceil(8 * points.size() + 1) - 1;
    std::vector<bool> once(mask + 1), again(mask + 1);
    for (const vec3& p : points) {
        const std::uint64_t bit = hash(p) & mask;
        if (once[bit])
            again[bit] = true;
        once[bit] = true;
    }
    std::vector<IndexedPoint> suspects;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (again[hash(points[i]) & mask])
            suspects.push_back({points[i], static_cast<std::uint32_t>(i)});
    std::sort(suspects.begin(), suspects.end(),
              [](const IndexedPoint& a, const IndexedPoint& b) { return a.key() < b.key(); });
    std::vector<std::uint32_t> first(points.size());
    std::iota(first.begin(), first.end(), 0u);
    for (std::size_t k = 1; k < suspects.size(); ++k)
        if (suspects[k].point == suspects[k - 1].point)
            first[suspects[k].index] = first[suspects[k - 1].index];
    return first;
}

}  // namespace brisance
