#include "elimination/coincident.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

namespace brisance {

namespace {

struct Place {
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

// Most points are alone with the bit their hash names. The few others are sorted.
std::vector<std::uint32_t> first_at_place(std::span<const vec3> points) {
    const std::uint64_t mask = std::bit_ceil(8 * points.size() + 1) - 1;
    std::vector<bool> once(mask + 1), again(mask + 1);
    for (const vec3& p : points) {
        const std::uint64_t bit = hash(p) & mask;
        if (once[bit])
            again[bit] = true;
        once[bit] = true;
    }
    std::vector<Place> places;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (again[hash(points[i]) & mask])
            places.push_back({points[i], static_cast<std::uint32_t>(i)});
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.key() < b.key(); });
    std::vector<std::uint32_t> first(points.size());
    std::iota(first.begin(), first.end(), 0u);
    for (std::size_t k = 1; k < places.size(); ++k)
        if (places[k].point == places[k - 1].point)
            first[places[k].index] = first[places[k - 1].index];
    return first;
}

}  // namespace brisance
