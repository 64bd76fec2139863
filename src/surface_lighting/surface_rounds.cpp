#include "surface_lighting/surface_rounds.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Rays along a pixel's side from which on few are shaded first: a quarter of fewer says nothing of their error.
constexpr std::size_t kLeastPerAxis = 4;

// In each row of four by four rays the column of the one that is shaded first: no two share a row or a column.
constexpr std::size_t kColumns[] = {2, 0, 3, 1};

// Of the variance of the few, what all rays leave.
constexpr float kLeftByAll = 0.25f;
// Of the variance that other light leaves: less is not worth a second round.
constexpr float kBesideOther = 0.25f;

constexpr std::uint32_t kNone = ~0u;

}  // namespace

SurfaceRounds::SurfaceRounds(std::span<const SurfaceSample> samples, int width, std::size_t rays, float tolerance)
    : samples_(samples),
      width_(static_cast<std::size_t>(width)),
      per_axis_(static_cast<std::size_t>(std::lround(std::sqrt(double(rays))))),
      tolerance_(tolerance) {
    const bool splits = tolerance > 0.0f && per_axis_ >= kLeastPerAxis && per_axis_ * per_axis_ == rays;
    if (!samples.empty())
        origin_ = samples.front().pixel / width_ * width_;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (pixels_.empty() || samples[i].pixel != samples[i - 1].pixel)
            pixels_.push_back({i, i});
        pixels_.back().end = i + 1;
        pixel_of_.push_back(static_cast<std::uint32_t>(pixels_.size() - 1));
    }
    for (Pixel& p : pixels_) {
        float all = 0.0f, few = 0.0f;
        for (std::size_t i = p.begin; i < p.end; ++i) {
            all += samples[i].share;
            few += among_few(i) ? samples[i].share : 0.0f;
        }
        p.few = splits && p.end - p.begin == rays && few > 0.0f;
        p.scale = p.few ? all / few : 1.0f;
        for (std::size_t i = p.begin; i < p.end; ++i)
            if (!p.few || among_few(i))
                first_.push_back(i);
    }
}

bool SurfaceRounds::among_few(std::size_t sample) const {
    const std::size_t ray = samples_[sample].number & 0xffffffffu;
    return ray % per_axis_ % 4 == kColumns[ray / per_axis_ % 4];
}

void SurfaceRounds::measure(Pixel& p, std::span<const float> even, const Found& found) const {
    float sum = 0.0f, squares = 0.0f, count = 0.0f;
    p.shown = samples_[p.begin].beside;
    for (std::size_t i = p.begin; i < p.end; ++i) {
        const float share = samples_[i].share;
        p.shown += share * even[i];
        if (p.few && !among_few(i))
            continue;
        const float seen = p.scale * share * found.noisy[i];
        p.shown += p.scale * share * found.shared[i];
        sum += seen;
        squares += seen * seen;
        count += 1.0f;
    }
    p.shown += sum;
    p.variance = p.few ? std::max(0.0f, squares - sum * sum / count) * count / (count - 1.0f) : 0.0f;
}

// By the pixels around, as far as the rows of this call reach.
void SurfaceRounds::decide(std::size_t number, float beside) {
    Pixel& own = pixels_[number];
    if (!own.few)
        return;
    const auto at = static_cast<int>(samples_[own.begin].pixel - origin_), width = static_cast<int>(width_);
    const int px = at % width, py = at / width, height = static_cast<int>(number_.size()) / width;
    float variance = 0.0f, estimates = 0.0f, shown = 0.0f, count = 0.0f;
    for (int y = std::max(py - 1, 0); y <= std::min(py + 1, height - 1); ++y)
        for (int x = std::max(px - 1, 0); x <= std::min(px + 1, width - 1); ++x) {
            const std::uint32_t other = number_[std::size_t(y) * width_ + x];
            if (other == kNone)
                continue;
            const Pixel& p = pixels_[other];
            shown += p.shown;
            count += 1.0f;
            if (!p.few)
                continue;
            variance += p.variance;
            estimates += 1.0f;
        }
    const float tolerated = tolerance_ * shown / count, found = std::max(own.variance, variance / estimates);
    // In this order what is not a number wants more.
    own.refined = !(found <= std::max(tolerated * tolerated, beside));
    own.left = own.refined ? found * kLeftByAll : found;
}

std::vector<std::size_t> SurfaceRounds::second(std::span<const float> even, const Found& found,
                                               const SurfaceRounds* other) {
    if (pixels_.empty())
        return {};
    const std::size_t rows = (samples_.back().pixel - origin_) / width_ + 1;
    number_.assign(rows * width_, kNone);
    for (std::uint32_t k = 0; k < pixels_.size(); ++k) {
        measure(pixels_[k], even, found);
        number_[samples_[pixels_[k].begin].pixel - origin_] = k;
    }
    std::vector<std::size_t> second;
    for (std::size_t k = 0; k < pixels_.size(); ++k) {
        decide(k, other ? kBesideOther * other->pixels_[k].left : 0.0f);
        Pixel& p = pixels_[k];
        if (!p.refined)
            continue;
        p.scale = 1.0f;
        for (std::size_t i = p.begin; i < p.end; ++i)
            if (!among_few(i))
                second.push_back(i);
    }
    return second;
}

float SurfaceRounds::stands_for(std::size_t sample) const {
    const Pixel& p = pixels_[pixel_of_[sample]];
    return p.few && !p.refined && !among_few(sample) ? 0.0f : p.scale;
}

}  // namespace brisance
