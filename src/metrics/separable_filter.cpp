#include "metrics/separable_filter.h"

#include <algorithm>

namespace brisance {
namespace {

void add_scaled(float weight, const float* from, float* to, std::size_t n) {
    for (std::size_t x = 0; x < n; ++x)
        to[x] += weight * from[x];
}

Plane along_rows(const Plane& plane, const Taps& taps) {
    const auto width = static_cast<std::size_t>(plane.width);
    const std::size_t radius = taps.size() / 2;
    Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
    parallel_for(static_cast<std::size_t>(plane.height), [&](std::size_t y) {
        const float* const row = plane.values.data() + y * width;
        std::vector<float> wide(width + 2 * radius);
        std::fill_n(wide.begin(), radius, row[0]);
        std::copy_n(row, width, wide.begin() + static_cast<std::ptrdiff_t>(radius));
        std::fill_n(wide.end() - static_cast<std::ptrdiff_t>(radius), radius, row[width - 1]);
        for (std::size_t k = 0; k < taps.size(); ++k)
            add_scaled(taps[k], wide.data() + k, result.values.data() + y * width, width);
    });
    return result;
}

Plane along_columns(const Plane& plane, const Taps& taps) {
    const auto width = static_cast<std::size_t>(plane.width);
    const int radius = static_cast<int>(taps.size() / 2);
    Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
    parallel_for(static_cast<std::size_t>(plane.height), [&](std::size_t y) {
        for (std::size_t k = 0; k < taps.size(); ++k) {
            const int from = std::clamp(static_cast<int>(y + k) - radius, 0, plane.height - 1);
            add_scaled(taps[k], plane.values.data() + static_cast<std::size_t>(from) * width,
                       result.values.data() + y * width, width);
        }
    });
    return result;
}

}  // namespace

Plane filtered(const Plane& plane, const Taps& across, const Taps& down) {
    return along_columns(along_rows(plane, across), down);
}

}  // namespace brisance
