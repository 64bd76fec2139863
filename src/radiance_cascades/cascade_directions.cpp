#include "radiance_cascades/cascade_directions.h"

#include <cmath>
#include <numbers>

namespace brisance {

namespace {

// Below this part of a moment, texels are too wide to know it: those of 2 x 2 directions know no z^2.
constexpr double kLeastKept = 1e-3;

// A square texel of the map by its middle.
struct Texel {
    double u, v;
};

std::vector<Texel> quartered(const std::vector<Texel>& texels, double half) {
    std::vector<Texel> parts;
    parts.reserve(texels.size() * 4);
    for (const Texel& t : texels)
        for (int k = 0; k < 4; ++k)
            parts.push_back({t.u + (k & 1 ? half : -half), t.v + (k & 2 ? half : -half)});
    return parts;
}

CascadeDirections::Basis mean_over(const Texel& texel, double width) {
    constexpr int kSamples = 16;  // along a side
    std::array<double, kShMoments> sum{};
    for (int k = 0; k < kSamples * kSamples; ++k) {
        const double x = (k / kSamples + 0.5) / kSamples - 0.5, y = (k % kSamples + 0.5) / kSamples - 0.5;
        const auto basis = sh_basis(-equal_area_direction(texel.u + x * width, texel.v + y * width));
        for (int m = 0; m < kShMoments; ++m)
            sum[m] += basis[m];
    }
    CascadeDirections::Basis mean;
    for (int m = 0; m < kShMoments; ++m)
        mean[m] = static_cast<float>(sum[m] / (kSamples * kSamples));
    return mean;
}

}  // namespace

vec3 equal_area_direction(double u, double v) {
    const double across = std::abs(u), up = std::abs(v), height = 1.0 - across - up;
    const double r = 1.0 - std::abs(height);
    const double angle = (r > 0.0 ? (up - across) / r + 1.0 : 1.0) * std::numbers::pi / 4.0;
    const double side = r * std::sqrt(2.0 - r * r);
    return vec3(std::copysign(std::cos(angle) * side, u), std::copysign(std::sin(angle) * side, v),
                std::copysign(1.0 - r * r, height));
}

CascadeDirections::CascadeDirections(int side, const std::vector<bool>& divided) {
    std::vector<Texel> texels;
    double width = 2.0 / side;
    for (int k = 0; k < side * side; ++k)
        texels.push_back({(k / side + 0.5) * width - 1.0, (k % side + 0.5) * width - 1.0});
    for (const Texel& t : texels)
        mean_.push_back(mean_over(t, width));
    const auto add = [&] {
        directions_.emplace_back();
        for (const Texel& t : texels)
            directions_.back().push_back(glm::normalize(equal_area_direction(t.u, t.v)));
    };
    add();
    for (const bool four : divided) {
        if (four) {
            texels = quartered(texels, 0.25 * width);
            width *= 0.5;
        }
        add();
    }
    // Even light has no moments, whatever the quadrature makes of them.
    for (int m = 0; m < kShMoments; ++m) {
        double even = 0.0;
        for (const Basis& b : mean_)
            even += b[m] / double(mean_.size());
        for (Basis& b : mean_)
            b[m] -= static_cast<float>(even);
    }
    std::array<double, kShMoments> kept{};
    for (const Basis& b : mean_)
        for (int m = 0; m < kShMoments; ++m)
            kept[m] += 4.0 * std::numbers::pi / double(mean_.size()) * b[m] * b[m];
    moment_ = mean_;
    for (Basis& b : moment_)
        for (int m = 0; m < kShMoments; ++m)
            b[m] = kept[m] > kLeastKept ? static_cast<float>(b[m] / kept[m]) : 0.0f;
}

}  // namespace brisance
