// [1] P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Moeller, Visualizing Errors in Rendered High Dynamic Range
// Images, Eurographics Short Papers, 2021. [2] K. Narkowicz, ACES Filmic Tone Mapping Curve, 2016.
// Departs from [1]: where the median luminance is black or nearly so, kDarkest below the brightest pixel, the median of
// the brighter pixels replaces it. Otherwise fire before a black background would need unbounded exposures.
#include "metrics/hdr_flip.h"

#include <algorithm>
#include <cmath>

#include "metrics/separable_filter.h"

namespace brisance {
namespace {

// [2] with its exposure of 0.6, the default tone curve of [1]: (a x^2 + b x) / (c x^2 + d x + e).
constexpr double kA = 2.51 * 0.36, kB = 0.03 * 0.6, kC = 2.43 * 0.36, kD = 0.59 * 0.6, kE = 0.14;
constexpr double kShownNearWhite = 0.85;
constexpr float kDarkest = 0x1p-20f;
constexpr double kBrightest = 1e6;  // above it the curve is 1 in single precision; squares stay finite

float tone(double x) {
    x = x > 0.0 ? std::min(x, kBrightest) : 0.0;  // NaN compares false
    return static_cast<float>(std::min((kA * x + kB) * x / ((kC * x + kD) * x + kE), 1.0));
}

// The argument at which the curve has this value.
double inverse_tone(double value) {
    const double a = kA - kC * value, b = kB - kD * value, c = -kE * value;
    return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

Picture shown(const Picture& picture, double exposure_stops) {
    const double scale = std::exp2(exposure_stops);
    Picture result{picture.width, picture.height, std::vector<Rgb>(picture.pixels.size())};
    for_each_pixel(picture.width, picture.height, [&](std::size_t i) {
        for (int c = 0; c < 3; ++c)
            result.pixels[i][c] = tone(scale * picture.pixels[i][c]);
    });
    return result;
}

// The lower median where the number of values is even.
float median(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

bool has_light(const Picture& picture) {
    return std::any_of(picture.pixels.begin(), picture.pixels.end(),
                       [](const Rgb& pixel) { return luminance(pixel) > 0.0f; });
}

}  // namespace

Exposures hdr_flip_exposures(const Picture& reference) {
    std::vector<float> luminances;
    for (const Rgb& pixel : reference.pixels)
        if (const float y = luminance(pixel); std::isfinite(y))
            luminances.push_back(std::max(y, 0.0f));
    const float largest = luminances.empty() ? 0.0f : *std::max_element(luminances.begin(), luminances.end());
    if (largest == 0.0f)
        return {};
    float middle = median(luminances);
    if (middle < kDarkest * largest) {
        std::erase_if(luminances, [&](float y) { return y < kDarkest * largest; });
        middle = median(luminances);
    }
    const double white = inverse_tone(kShownNearWhite);
    Exposures result{std::log2(white / largest), std::log2(white / middle)};
    result.count = std::max(2, static_cast<int>(std::ceil(result.stop - result.start)));
    return result;
}

HdrFlip hdr_flip(const Picture& image, const Picture& reference, double pixels_per_degree) {
    // Against a black reference the image itself decides the exposures, so that its light is visible.
    HdrFlip result;
    result.exposures = hdr_flip_exposures(has_light(reference) ? reference : image);
    const std::size_t count = reference.pixels.size();
    result.errors = {reference.width, reference.height, std::vector<float>(count)};
    result.worst_exposures.assign(count, 0);
    for (int e = 0; e < result.exposures.count; ++e) {
        const double stops = result.exposures.at(e);
        const Plane errors = flip_errors(shown(image, stops), shown(reference, stops), pixels_per_degree);
        for (std::size_t i = 0; i < count; ++i) {
            if (errors.values[i] <= result.errors.values[i])
                continue;
            result.errors.values[i] = errors.values[i];
            result.worst_exposures[i] = e;
        }
    }
    result.mean = mean_of(result.errors);
    return result;
}

}  // namespace brisance
