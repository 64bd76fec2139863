#include "emitters/sky_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "emitters/texel_means.h"

namespace brisance {

namespace {

using std::numbers::pi;

// Of an environment without a picture.
constexpr int kPlainWidth = 64, kPlainHeight = 32;
// What is added to the luminance, of its mean.
constexpr double kDarkest = 0.05;

bool dimmer(const SkyPart& a, const SkyPart& b) {
    return a.irradiance < b.irradiance;
}

}  // namespace

SkyParts::SkyParts(const Environment& environment, std::size_t most)
    : environment_(environment),
      width_(environment.picture() ? environment.picture()->width : kPlainWidth),
      height_(environment.picture() ? environment.picture()->height : kPlainHeight) {
    const auto stride = std::size_t(width_) + 1;
    sums_.assign(stride * (std::size_t(height_) + 1), 0.0);
    std::vector<float> light(std::size_t(width_) * std::size_t(height_));
    parallel_for(std::size_t(height_), [&](std::size_t y) {
        for (int x = 0; x < width_; ++x) {
            const dvec3 middle = environment.direction_of((x + 0.5) / width_, (double(y) + 0.5) / height_);
            light[y * std::size_t(width_) + std::size_t(x)] = std::max(0.0f, luminance(environment.radiance(middle)));
        }
    });
    light = texel_means(light, width_, height_);
    parallel_for(std::size_t(height_), [&](std::size_t y) {
        const double solid_angle =
            2.0 * pi / width_ * (std::cos(polar(static_cast<int>(y))) - std::cos(polar(static_cast<int>(y) + 1)));
        double row = 0.0;
        for (int x = 0; x < width_; ++x) {
            row += light[y * std::size_t(width_) + std::size_t(x)] * solid_angle;
            sums_[(y + 1) * stride + std::size_t(x) + 1] = row;
        }
    });
    for (std::size_t i = 2 * stride; i < sums_.size(); ++i)
        sums_[i] += sums_[i - stride];
    even_ = kDarkest * sums_.back() / (4.0 * pi);
    if (!(even_ > 0.0))
        return;
    // A heap: the brightest stands first.
    parts_.push_back(part_of(0, width_, 0, height_));
    std::vector<SkyPart> whole;
    while (!parts_.empty() && parts_.size() + whole.size() < most) {
        std::pop_heap(parts_.begin(), parts_.end(), dimmer);
        const SkyPart divided = parts_.back();
        parts_.pop_back();
        SkyPart first, second;
        if (!halves(divided, first, second)) {
            whole.push_back(divided);
            continue;
        }
        for (const SkyPart& half : {first, second}) {
            parts_.push_back(half);
            std::push_heap(parts_.begin(), parts_.end(), dimmer);
        }
    }
    parts_.insert(parts_.end(), whole.begin(), whole.end());
}

// Of the upper edge of a row.
double SkyParts::polar(int row) const {
    return pi * row / height_;
}

double SkyParts::light_between(int left, int right, int top, int bottom) const {
    const auto at = [&](int x, int y) { return sums_[std::size_t(y) * (std::size_t(width_) + 1) + std::size_t(x)]; };
    return std::max(0.0, at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top));
}

double SkyParts::solid_angle(const SkyPart& part) const {
    return 2.0 * pi * (part.right - part.left) / width_ * (std::cos(polar(part.top)) - std::cos(polar(part.bottom)));
}

// Every direction is reached from the middle along the meridian and then along its parallel: no farther than both.
SkyPart SkyParts::part_of(int left, int right, int top, int bottom) const {
    SkyPart out{left, right, top, bottom};
    out.irradiance = light_between(left, right, top, bottom) + even_ * solid_angle(out);
    const double middle = 0.5 * (polar(top) + polar(bottom)), across = pi * (right - left) / width_;
    const double high = polar(top), low = polar(bottom);
    const double widest = high < pi / 2.0 && low > pi / 2.0 ? 1.0 : std::max(std::sin(high), std::sin(low));
    out.toward = environment_.direction_of(0.5 * (left + right) / width_, middle / pi);
    out.spread = std::min(pi, 0.5 * (low - high) + widest * across);
    return out;
}

bool SkyParts::halves(const SkyPart& p, SkyPart& first, SkyPart& second) const {
    const int columns = p.right - p.left, rows = p.bottom - p.top;
    if (columns < 2 && rows < 2)
        return false;
    const double sine = std::sin(0.5 * (polar(p.top) + polar(p.bottom)));
    const double wide = 2.0 * pi * columns / width_ * sine, tall = pi * rows / height_;
    if (rows < 2 || (columns > 1 && wide > tall)) {
        const int middle = p.left + columns / 2;
        first = part_of(p.left, middle, p.top, p.bottom);
        second = part_of(middle, p.right, p.top, p.bottom);
    } else {
        const int middle = p.top + rows / 2;
        first = part_of(p.left, p.right, p.top, middle);
        second = part_of(p.left, p.right, middle, p.bottom);
    }
    return true;
}

dvec3 SkyParts::sample(const SkyPart& part, double u, double v) const {
    const double high = std::cos(polar(part.top)), low = std::cos(polar(part.bottom));
    const double angle = std::acos(std::clamp(high + v * (low - high), -1.0, 1.0));
    return environment_.direction_of((part.left + u * (part.right - part.left)) / width_, angle / pi);
}

}  // namespace brisance
