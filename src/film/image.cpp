#include "film/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"

namespace brisance {

const Layer& Image::layer(const std::string& name) const {
    std::string there;
    for (const Layer& layer : layers) {
        if (layer.name == name)
            return layer;
        there += fmt::format("{}{}", there.empty() ? "" : ", ", layer.name.empty() ? "beauty" : layer.name);
    }
    throw Error(ExitCode::BadData, fmt::format("the image has no layer \"{}\"; it has {}",
                                               name.empty() ? "beauty" : name, there.empty() ? "none" : there));
}

void add_to_mean(Image& mean, const Image& next, int count) {
    for (std::size_t l = 0; l < mean.layers.size(); ++l)
        for (std::size_t i = 0; i < mean.layers[l].pixels.size(); ++i) {
            float& pixel = mean.layers[l].pixels[i];
            pixel += (next.layers[l].pixels[i] - pixel) / float(count);
        }
}

double sum_of_squares(const Layer& layer) {
    constexpr std::size_t kBlock = 1 << 16;
    const std::size_t n = layer.channels.size(), pixels = layer.pixels.size() / n;
    std::vector<double> sums(pixels / kBlock + 1, 0.0);
    parallel_blocks(pixels, kBlock, [&](std::size_t begin, std::size_t end) {
        double& sum = sums[begin / kBlock];
        for (std::size_t p = begin; p < end; ++p)
            for (std::size_t c = 0; c < std::min<std::size_t>(n, 3); ++c)
                if (const double v = layer.pixels[p * n + c]; std::isfinite(v))
                    sum += v * v;
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace brisance
