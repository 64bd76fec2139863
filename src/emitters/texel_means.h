// What bilinear interpolation makes of a picture around the sky: the mean over each texel, by which directions are
// drawn. Beside a bright texel it is an eighth of that, where the value at the middle knows nothing of it.
#pragma once

#include <algorithm>
#include <vector>

namespace brisance {

// `middles`: values at the middles of texels, row after row. Columns go round, rows end at the poles. The mean of a
// piecewise linear function over a cell around its kink is 1/8, 3/4 and 1/8 of its values there and beside.
inline std::vector<float> texel_means(const std::vector<float>& middles, int width, int height) {
    const auto mean = [](float before, float own, float after) { return 0.125f * (before + after) + 0.75f * own; };
    std::vector<float> along(middles.size()), out(middles.size());
    for (int y = 0; y < height; ++y) {
        const std::size_t row = std::size_t(y) * std::size_t(width);
        for (int x = 0; x < width; ++x)
            along[row + std::size_t(x)] =
                mean(middles[row + std::size_t((x + width - 1) % width)], middles[row + std::size_t(x)],
                     middles[row + std::size_t((x + 1) % width)]);
    }
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto at = [&](int row) {
                return along[std::size_t(std::clamp(row, 0, height - 1)) * std::size_t(width) + std::size_t(x)];
            };
            out[std::size_t(y) * std::size_t(width) + std::size_t(x)] = mean(at(y - 1), at(y), at(y + 1));
        }
    return out;
}

}  // namespace brisance
