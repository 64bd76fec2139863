#include "metrics/differences.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace brisance {
namespace {

double ratio(double numerator, double denominator) {
    if (denominator != 0.0)
        return numerator / denominator;
    return numerator == 0.0 ? 0.0 : std::copysign(std::numeric_limits<double>::infinity(), numerator);
}

double sum(const dvec3& v) {
    return v.x + v.y + v.z;
}

double mean_magnitude(std::span<const Rgb> pixels) {
    double total = 0.0;
    for (const Rgb& pixel : pixels)
        total += sum(glm::abs(dvec3(pixel)));
    return pixels.empty() ? 0.0 : total / (3.0 * static_cast<double>(pixels.size()));
}

// Channels averaged.
double relative_square(const dvec3& i, const dvec3& r, double epsilon) {
    double total = 0.0;
    for (int c = 0; c < 3; ++c)
        total += ratio((i[c] - r[c]) * (i[c] - r[c]), r[c] * r[c] + epsilon * epsilon);
    return total / 3.0;
}

double relative_magnitude(const dvec3& i, const dvec3& r, double epsilon) {
    double total = 0.0;
    for (int c = 0; c < 3; ++c)
        total += ratio(std::abs(i[c] - r[c]), std::abs(r[c]) + epsilon);
    return total / 3.0;
}

double mean_without_largest(std::vector<double>& errors, std::size_t trimmed) {
    if (errors.empty())
        return 0.0;
    const auto kept = errors.end() - static_cast<std::ptrdiff_t>(trimmed);
    if (trimmed > 0)
        std::nth_element(errors.begin(), kept, errors.end());
    double total = 0.0;
    for (auto error = errors.begin(); error != kept; ++error)
        total += *error;
    return total / static_cast<double>(errors.size() - trimmed);
}

}  // namespace

Differences measure_differences(std::span<const Rgb> image, std::span<const Rgb> reference) {
    assert(image.size() == reference.size());
    Differences result;
    result.epsilon = kEpsilonShare * mean_magnitude(reference);
    result.trimmed = static_cast<std::size_t>(kTrimmedShare * static_cast<double>(image.size()));
    double square = 0.0, norm = 0.0, bias = 0.0, total = 0.0, magnitudes = 0.0;
    std::vector<double> relative_squares(image.size());
    for (std::size_t p = 0; p < image.size(); ++p) {
        const dvec3 i(image[p]), r(reference[p]);
        const dvec3 difference = i - r;
        square += glm::dot(difference, difference);
        norm += glm::dot(r, r);
        bias += sum(difference);
        total += sum(r);
        magnitudes += relative_magnitude(i, r, result.epsilon);
        relative_squares[p] = relative_square(i, r, result.epsilon);
    }
    result.rrmse = std::sqrt(ratio(square, norm));
    result.relmse = mean_without_largest(relative_squares, result.trimmed);
    result.mape = ratio(magnitudes, static_cast<double>(image.size()));
    result.mean = ratio(bias, total);
    return result;
}

HalvesDifferences measure_halves(std::span<const Rgb> image, std::span<const Rgb> a, std::span<const Rgb> b) {
    assert(image.size() == a.size() && image.size() == b.size());
    double cross = 0.0, product = 0.0, spread = 0.0, norm = 0.0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        const dvec3 i(image[p]), ra(a[p]), rb(b[p]);
        cross += glm::dot(i - ra, i - rb);
        product += glm::dot(ra, rb);
        spread += glm::dot(ra - rb, ra - rb);
        norm += glm::dot(ra + rb, ra + rb);
    }
    return {std::sqrt(ratio(std::max(cross, 0.0), std::max(product, 0.0))), std::sqrt(ratio(spread, norm))};
}

}  // namespace brisance
