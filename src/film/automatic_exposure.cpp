#include <algorithm>
#include <cmath>
#include <vector>

#include "film/write_image.h"

namespace brisance {

namespace {

constexpr double kPercentile = 0.99;  // of the pixels that are lit at all: independent of how much black surrounds them
constexpr float kNearlyBlack = 1e-4f;  // of the brightest pixel: not lit
constexpr float kJustBelowWhite = 0.9f;

}  // namespace

float automatic_exposure(const Image& image) {
    const Layer& beauty = image.layer("");
    const std::size_t channels = beauty.channels.size();
    if (channels < 3)
        return 0.0f;
    std::vector<float> lit;
    for (std::size_t i = 0; i + channels <= beauty.pixels.size(); i += channels) {
        const float y = luminance(Rgb(beauty.pixels[i], beauty.pixels[i + 1], beauty.pixels[i + 2]));
        if (std::isfinite(y) && y > 0.0f)
            lit.push_back(y);
    }
    if (lit.empty())
        return 0.0f;
    const float threshold = kNearlyBlack * *std::max_element(lit.begin(), lit.end());
    lit.erase(std::remove_if(lit.begin(), lit.end(), [&](float y) { return y < threshold; }), lit.end());
    const auto rank = lit.begin() + static_cast<std::ptrdiff_t>(kPercentile * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), rank, lit.end());
    return std::log2(kJustBelowWhite / *rank);
}

}  // namespace brisance
