#include "pixel_sharing/grain_finder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "pixel_sharing/share_light.h"

namespace brisance {

namespace {

// By how much the pixel of a grain stands out of those around.
constexpr float kStandsOut = 1.5f;

// Pixels to each side that are looked at, and how many of them may show as much: a line one pixel wide has one more.
constexpr int kPixelsAround = 3;
constexpr std::size_t kLikeIt = 2 * kPixelsAround - 1;

// A part of a sample goes with its grain where it makes this part of it.
constexpr float kOfGrain = 0.1f;

float sum(const std::array<float, 3>& parts) {
    return parts[0] + parts[1] + parts[2];
}

}  // namespace

// What pixels around show: those on the same surface or, where few are, all.
struct GrainFinder::Around {
    std::vector<float> luminances;
    float on_surface = 0.0f;  // how many of these are

    // But for those that are like a grain.
    float most() {
        if (luminances.empty())
            return 0.0f;
        const auto at = luminances.begin() + std::ptrdiff_t(std::min(kLikeIt, luminances.size() - 1));
        std::ranges::nth_element(luminances, at, std::greater());
        return *at;
    }
};

GrainFinder::GrainFinder(std::span<const SurfaceSample> samples, std::vector<Shown> shown, int width,
                         const SharedBounce* shared, DividedGrains& grains)
    : samples_(samples),
      shown_(std::move(shown)),
      width_(static_cast<std::size_t>(width)),
      shared_(shared),
      grains_(grains) {
    if (samples.empty())
        return;
    origin_ = samples.front().pixel / width_ * width_;
    pixels_.resize(((samples.back().pixel - origin_) / width_ + 1) * width_);
    for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
        Pixel& p = pixels_[samples[begin].pixel - origin_];
        p = {samples[begin].beside, begin, begin};
        float share = 0.0f;
        std::size_t largest = begin;
        const auto rank = [&](std::size_t i) { return std::pair(shown_[i].normal != vec3(0.0f), samples[i].share); };
        for (; end < samples.size() && samples[end].pixel == samples[begin].pixel; ++end) {
            p.luminance += shown_[end].luminance;
            share += samples[end].share;
            if (rank(end) > rank(largest))
                largest = end;
        }
        p.end = end;
        DividedGrains::Surface first = surface(largest);
        first.share = share;
        grains.show(samples[begin].pixel, first);
    }
}

DividedGrains::Surface GrainFinder::surface(std::size_t sample) const {
    const SurfaceSample& s = samples_[sample];
    return {vec3(s.ray.origin + s.hit.distance * s.ray.direction), shown_[sample].normal, s.hit.mesh, s.share};
}

GrainFinder::Around GrainFinder::around(std::size_t sample) const {
    const auto at = static_cast<int>(samples_[sample].pixel - origin_), width = static_cast<int>(width_);
    const int px = at % width, py = at / width, height = static_cast<int>(pixels_.size()) / width;
    const DividedGrains::Surface own = surface(sample);
    Around of_surface, of_all;
    for (int y = std::max(py - kPixelsAround, 0); y <= std::min(py + kPixelsAround, height - 1); ++y)
        for (int x = std::max(px - kPixelsAround, 0); x <= std::min(px + kPixelsAround, width - 1); ++x) {
            const Pixel& p = pixels_[std::size_t(y) * width_ + std::size_t(x)];
            if ((x == px && y == py) || p.end == p.begin || !std::isfinite(p.luminance))
                continue;
            of_all.luminances.push_back(p.luminance);
            for (std::size_t i = p.begin; i < p.end; ++i)
                if (DividedGrains::on_one_surface(own, surface(i))) {
                    of_surface.luminances.push_back(p.luminance);
                    of_surface.on_surface += 1.0f;
                    break;
                }
        }
    return of_surface.luminances.size() > kLikeIt ? of_surface : of_all;
}

GrainFinder::Parts GrainFinder::parts(const Sample& s) const {
    Parts out{s.stands_for * samples_[s.number].share * luminance(s.found), 0.0f, 0.0f};
    for (std::size_t k = 0; k < s.left.size(); ++k)
        if (s.left[k])
            out[k + 1] = s.stands_for * luminance(s.left[k]->shown());
    return out;
}

// What no other sample tells, where so many pixels show its surface.
GrainFinder::Parts GrainFinder::alone(const Sample& s, const Parts& parts, float pixels) const {
    Parts out = parts;
    for (std::size_t k = 0; k < s.left.size(); ++k)
        if (s.left[k])
            out[k + 1] /= std::min(pixels, shared_->pixels_within(*s.left[k], s.left[k]->closeness));
    return out;
}

bool GrainFinder::take(const Sample& s) {
    const Parts all = parts(s);
    const float of_pixel = pixels_[samples_[s.number].pixel - origin_].luminance,
                beside = std::max(0.0f, of_pixel - s.times * sum(all));
    // What is not finite stays where it is.
    if (!(sum(all) > beside) || !std::isfinite(of_pixel + sum(all)))
        return false;
    Around near = around(s.number);
    const Parts apart = alone(s, all, 1.0f + near.on_surface);
    const float least = std::max(near.most(), beside), grain = sum(apart);
    if (near.luminances.empty() || !(grain > beside && beside + grain > kStandsOut * near.most()))
        return false;
    DividedGrains::Grain out{samples_[s.number].pixel, surface(s.number), 0.0f, {}};
    CellSum light;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (!(apart[k] > kOfGrain * grain))
            continue;
        out.excess += all[k];
        if (k == 0) {
            light.add(s.found, Rgb(s.stands_for * samples_[s.number].share));
            continue;
        }
        SharedBounce::Sample& left = *s.left[k - 1];
        light.add(shown_by_cell(left), Rgb(s.stands_for));
        left.light = Rgb(0.0f);
        left.apart = {};
    }
    out.excess /= std::max(least, 1e-6f * out.excess);
    for (std::size_t k = 0; k < out.light.size(); ++k)
        out.light[k] = light.at(DividedGrains::kOfSurfaces[k]);
    grains_.add(out);
    return apart[0] > kOfGrain * grain;
}

}  // namespace brisance
