// [1] P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astrom, M. D. Fairchild, FLIP: A Difference
// Evaluator for Alternating Images, Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020.
// Departs from [1] in arithmetic alone: its two-dimensional filters are sums of products of one-dimensional ones on the
// square they are cut to, and are applied as such.
#include "metrics/flip.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "metrics/colour_space.h"
#include "metrics/separable_filter.h"

namespace brisance {
namespace {

// [1], spatial filtering: contrast sensitivity as a sum of Gaussians a sqrt(pi / b) exp(-pi^2 d^2 / b) of the
// distance d [degrees].
struct Gaussian {
    double a, b;  // [1], [degrees^2]
};
constexpr Gaussian kAchromatic{1.0, 0.0047};
constexpr Gaussian kRedGreen{1.0, 0.0053};
constexpr std::array kBlueYellow = {Gaussian{34.1, 0.04}, Gaussian{13.5, 0.025}};
constexpr double kWidestScale = 0.04;  // the largest b: all filters are cut at three of its standard deviations

// [1], colour and feature metric: colour differences to the power kColourPower, of which the share kKnee of the largest
// takes up kKneeValue of the scale; features to the power kFeaturePower, their detector's width in degrees.
constexpr float kColourPower = 0.7f;
constexpr float kKnee = 0.4f;
constexpr float kKneeValue = 0.95f;
constexpr float kFeaturePower = 0.5f;
constexpr double kFeatureWidth = 0.082;

template <class Weight>
Taps taps_of(int radius, const Weight& weight) {
    Taps taps;
    for (int i = -radius; i <= radius; ++i)
        taps.push_back(static_cast<float>(weight(static_cast<double>(i))));
    return taps;
}

// The positive weights add up to 1, the negative ones, if any, to -1.
template <class Weight>
Taps balanced_taps(int radius, const Weight& weight) {
    double positive = 0.0, negative = 0.0;
    for (int i = -radius; i <= radius; ++i) {
        positive += std::max(weight(static_cast<double>(i)), 0.0);
        negative -= std::min(weight(static_cast<double>(i)), 0.0);
    }
    return taps_of(radius, [&](double x) { return weight(x) / (weight(x) < 0.0 ? negative : positive); });
}

// One Gaussian of a contrast sensitivity, along one axis.
struct ContrastFilter {
    Taps taps;     // add up to 1
    double share;  // of the whole two-dimensional filter, before it is made to add up to 1
};

ContrastFilter contrast_filter(const Gaussian& gaussian, double pixels_per_degree) {
    constexpr double pi = std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidestScale / (2.0 * pi * pi)) * pixels_per_degree));
    const auto weight = [&](double x) {
        const double degrees = x / pixels_per_degree;
        return std::exp(-pi * pi * degrees * degrees / gaussian.b);
    };
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i)
        sum += weight(static_cast<double>(i));
    return {balanced_taps(radius, weight), gaussian.a * std::sqrt(pi / gaussian.b) * sum * sum};
}

struct FeatureFilters {
    Taps smooth, slope, curvature;
};

FeatureFilters feature_filters(double pixels_per_degree) {
    const double sigma = 0.5 * kFeatureWidth * pixels_per_degree;  // [pixels]
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    const auto gaussian = [&](double x) { return std::exp(-x * x / (2.0 * sigma * sigma)); };
    return {balanced_taps(radius, gaussian), balanced_taps(radius, [&](double x) { return -x * gaussian(x); }),
            balanced_taps(radius, [&](double x) { return (x * x / (sigma * sigma) - 1.0) * gaussian(x); })};
}

using Planes = std::array<Plane, 3>;

Planes to_ycxcz(const Picture& picture) {
    const Plane empty{picture.width, picture.height, std::vector<float>(picture.pixels.size())};
    Planes planes = {empty, empty, empty};
    for_each_pixel(picture.width, picture.height, [&](std::size_t i) {
        const vec3 value = ycxcz_from_linear(glm::clamp(picture.pixels[i], 0.0f, 1.0f));
        for (int c = 0; c < 3; ++c)
            planes[static_cast<std::size_t>(c)].values[i] = value[c];
    });
    return planes;
}

Plane filtered_blue_yellow(const Plane& plane, double pixels_per_degree) {
    const ContrastFilter wide = contrast_filter(kBlueYellow[0], pixels_per_degree);
    const ContrastFilter narrow = contrast_filter(kBlueYellow[1], pixels_per_degree);
    const auto share = static_cast<float>(wide.share / (wide.share + narrow.share));
    Plane result = filtered(plane, wide.taps, wide.taps);
    const Plane other = filtered(plane, narrow.taps, narrow.taps);
    for_each_pixel(plane.width, plane.height, [&](std::size_t i) {
        result.values[i] = share * result.values[i] + (1.0f - share) * other.values[i];
    });
    return result;
}

// CIELAB with the Hunt effect: what is dark looks less colourful.
vec3 hunt_lab(const Rgb& linear) {
    const vec3 lab = lab_from_linear(linear);
    return {lab.x, 0.01f * lab.x * lab.y, 0.01f * lab.x * lab.z};
}

// The colours that the eye resolves at this distance.
std::vector<vec3> perceived(const Planes& ycxcz, double pixels_per_degree) {
    const Taps achromatic = contrast_filter(kAchromatic, pixels_per_degree).taps;
    const Taps red_green = contrast_filter(kRedGreen, pixels_per_degree).taps;
    const Plane y = filtered(ycxcz[0], achromatic, achromatic);
    const Plane cx = filtered(ycxcz[1], red_green, red_green);
    const Plane cz = filtered_blue_yellow(ycxcz[2], pixels_per_degree);
    std::vector<vec3> result(y.values.size());
    for_each_pixel(y.width, y.height, [&](std::size_t i) {
        const Rgb linear = linear_from_ycxcz({y.values[i], cx.values[i], cz.values[i]});
        result[i] = hunt_lab(glm::clamp(linear, 0.0f, 1.0f));
    });
    return result;
}

// HyAB: city block between lightness and colour, Euclidean within colour; holds for large differences too.
float hyab(const vec3& a, const vec3& b) {
    const vec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// [1], redistribution: the largest difference a display can show, pure green against pure blue, becomes 1.
float colour_error(float distance) {
    static const float largest =
        std::pow(hyab(hunt_lab({0.0f, 1.0f, 0.0f}), hunt_lab({0.0f, 0.0f, 1.0f})), kColourPower);
    const float power = std::pow(distance, kColourPower);
    const float knee = kKnee * largest;
    return power < knee ? kKneeValue * power / knee
                        : kKneeValue + (power - knee) / (largest - knee) * (1.0f - kKneeValue);
}

// [1], feature detection: strength of edges and of points per pixel.
std::array<Plane, 2> features(Plane lightness, const FeatureFilters& filters) {
    for (float& value : lightness.values)
        value = (value + 16.0f) / 116.0f;
    std::array<Plane, 2> result;
    for (std::size_t kind = 0; kind < 2; ++kind) {
        const Taps& taps = kind == 0 ? filters.slope : filters.curvature;
        result[kind] = filtered(lightness, taps, filters.smooth);
        const Plane down = filtered(lightness, filters.smooth, taps);
        for_each_pixel(lightness.width, lightness.height, [&](std::size_t i) {
            result[kind].values[i] = std::hypot(result[kind].values[i], down.values[i]);
        });
    }
    return result;
}

void check(const Picture& image, const Picture& reference, double pixels_per_degree) {
    if (image.width != reference.width || image.height != reference.height)
        throw Error(ExitCode::BadData, fmt::format("an image of {} x {} pixels cannot be compared with one of {} x {}",
                                                   image.width, image.height, reference.width, reference.height));
    if (!(pixels_per_degree >= 1.0 && pixels_per_degree <= 1000.0))
        throw Error(ExitCode::Usage,
                    fmt::format("{} pixels per degree: expected a number in [1, 1000]", pixels_per_degree));
}

}  // namespace

Plane flip_errors(const Picture& image, const Picture& reference, double pixels_per_degree) {
    check(image, reference, pixels_per_degree);
    const Planes image_planes = to_ycxcz(image), reference_planes = to_ycxcz(reference);
    const std::vector<vec3> seen = perceived(image_planes, pixels_per_degree);
    const std::vector<vec3> wanted = perceived(reference_planes, pixels_per_degree);
    const FeatureFilters filters = feature_filters(pixels_per_degree);
    const std::array<Plane, 2> found = features(image_planes[0], filters);
    const std::array<Plane, 2> expected = features(reference_planes[0], filters);
    Plane errors{image.width, image.height, std::vector<float>(image.pixels.size())};
    for_each_pixel(image.width, image.height, [&](std::size_t i) {
        const float colour = colour_error(hyab(seen[i], wanted[i]));
        const float edge = std::abs(found[0].values[i] - expected[0].values[i]);
        const float point = std::abs(found[1].values[i] - expected[1].values[i]);
        const float feature = std::pow(std::max(edge, point) / std::numbers::sqrt2_v<float>, kFeaturePower);
        // A difference of features amplifies that of colours: the exponent falls below 1.
        errors.values[i] = std::pow(colour, 1.0f - std::min(feature, 1.0f));
    });
    return errors;
}

double mean_of(const Plane& plane) {
    double total = 0.0;
    for (const float value : plane.values)
        total += value;
    return plane.values.empty() ? 0.0 : total / static_cast<double>(plane.values.size());
}

}  // namespace brisance
