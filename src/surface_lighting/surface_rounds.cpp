#include "surface_lighting/surface_rounds.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Rays along a pixel's side from which on few are shaded first: a quarter of fewer says nothing of their error.
constexpr std::size_t kLeastPerAxis = 4;

// In each row of four by four rays the columns in the order in which they are shaded, quarter by quarter: in none do
// two share a row or a column.
constexpr std::uint32_t kQuarters[4][4] = {{2, 1, 0, 3}, {0, 3, 2, 1}, {3, 0, 1, 2}, {1, 2, 3, 0}};

// In all: grains that these leave are for other estimators.
constexpr std::uint32_t kMostPasses = 4;

// Of the variance that other light leaves: less is not worth a second round.
constexpr float kBesideOther = 0.25f;

// Pixels to each side whose variance counts, and for how much those do that are not the next. Light that its own
// samples tell of, too, has narrow edges.
constexpr int kAround = 2, kAroundEdges = 1;
constexpr float kFarther = 0.5f;

constexpr std::uint32_t kNone = ~0u;

}  // namespace

bool SurfaceRounds::split(std::size_t rays) {
    const auto per_axis = static_cast<std::size_t>(std::lround(std::sqrt(double(rays))));
    return per_axis >= kLeastPerAxis && per_axis * per_axis == rays;
}

SurfaceRounds::SurfaceRounds(std::span<const SurfaceSample> samples, int width, std::size_t rays,
                             const Tolerance& tolerance, ToldBy told_by)
    : samples_(samples),
      width_(static_cast<std::size_t>(width)),
      per_axis_(static_cast<std::size_t>(std::lround(std::sqrt(double(rays))))),
      tolerance_(tolerance),
      told_by_(told_by),
      splits_(tolerance.part > 0.0f && split(rays)) {
    if (!samples.empty())
        origin_ = samples.front().pixel / width_ * width_;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (pixels_.empty() || samples[i].pixel != samples[i - 1].pixel)
            pixels_.push_back({i, i});
        pixels_.back().end = i + 1;
        pixel_of_.push_back(static_cast<std::uint32_t>(pixels_.size() - 1));
    }
    if (splits_ && !samples.empty()) {
        number_.assign(((samples.back().pixel - origin_) / width_ + 1) * width_, kNone);
        for (std::uint32_t k = 0; k < pixels_.size(); ++k)
            number_[samples[pixels_[k].begin].pixel - origin_] = k;
    }
    for (Pixel& p : pixels_) {
        if (splits_ && p.end - p.begin == rays)
            shade(p, 1);
        for (std::size_t i = p.begin; i < p.end; ++i)
            if (quarter_of(i) < p.quarters)
                first_.push_back(i);
    }
}

std::uint32_t SurfaceRounds::quarter_of(std::size_t sample) const {
    const std::size_t ray = samples_[sample].number & 0xffffffffu;
    return static_cast<std::uint32_t>(
        std::ranges::find(kQuarters[ray / per_axis_ % 4], static_cast<std::uint32_t>(ray % per_axis_ % 4)) -
        kQuarters[ray / per_axis_ % 4]);
}

void SurfaceRounds::shade(Pixel& p, std::uint32_t quarters) const {
    float all = 0.0f, shaded = 0.0f;
    for (std::size_t i = p.begin; i < p.end; ++i) {
        all += samples_[i].share;
        shaded += quarter_of(i) < quarters ? samples_[i].share : 0.0f;
    }
    if (!(shaded > 0.0f))
        return;
    p.quarters = quarters;
    p.scale = quarters == 4 ? 1.0f : all / shaded;
}

void SurfaceRounds::measure(Pixel& p, std::span<const float> even, const Found& found) const {
    float sum = 0.0f, squares = 0.0f, count = 0.0f;
    p.shown = samples_[p.begin].beside;
    for (std::size_t i = p.begin; i < p.end; ++i) {
        const float share = samples_[i].share;
        p.shown += share * even[i];
        if (quarter_of(i) >= p.quarters)
            continue;
        const float seen = p.scale * share * found.noisy[i];
        p.shown += p.scale * share * found.shared[i];
        sum += seen;
        squares += seen * seen;
        count += 1.0f;
    }
    p.shown += sum;
    const float variance = count > 1.0f ? std::max(0.0f, squares - sum * sum / count) * count / (count - 1.0f) : 0.0f;
    p.variance = variance * float(p.quarters);
}

// By the pixels around, as far as the rows of this call reach.
SurfaceRounds::Wanted SurfaceRounds::wanted(const Pixel& own, float beside) const {
    const auto at = static_cast<int>(samples_[own.begin].pixel - origin_), width = static_cast<int>(width_);
    const int px = at % width, py = at / width, height = static_cast<int>(number_.size()) / width;
    const int reach = told_by_ == ToldBy::OwnToo ? kAroundEdges : kAround;
    float variance = 0.0f, weights = 0.0f, shown = 0.0f, count = 0.0f;
    for (int y = std::max(py - reach, 0); y <= std::min(py + reach, height - 1); ++y)
        for (int x = std::max(px - reach, 0); x <= std::min(px + reach, width - 1); ++x) {
            const std::uint32_t other = number_[std::size_t(y) * width_ + x];
            if (other == kNone)
                continue;
            const Pixel& p = pixels_[other];
            shown += p.shown;
            count += 1.0f;
            if (&p == &own)
                continue;
            const float weight = std::max(std::abs(x - px), std::abs(y - py)) > 1 ? kFarther : 1.0f;
            weights += weight;
            variance += weight * p.variance;
        }
    const float around = weights > 0.0f ? variance / weights : own.variance,
                told = told_by_ == ToldBy::OwnToo ? std::max(own.variance, around) : around,
                found = told / float(own.quarters);
    const float seen = shown / count, typical = tolerance_.typical > 0.0f ? tolerance_.typical : seen,
                limit = std::max(tolerance_.part * tolerance_.part * typical * seen, beside);
    return {found <= limit ? 0.0f : found / limit, found};
}

std::vector<std::size_t> SurfaceRounds::second(std::span<const float> even, const Found& found,
                                               const SurfaceRounds* other) {
    if (pixels_.empty() || !splits_)
        return {};
    std::ranges::for_each(pixels_, [&](Pixel& p) { measure(p, even, found); });
    std::vector<std::size_t> second;
    for (std::size_t k = 0; k < pixels_.size(); ++k) {
        Pixel& p = pixels_[k];
        const auto [times, left] = wanted(p, other ? kBesideOther * other->pixels_[k].left : 0.0f);
        p.left = left;
        if (p.quarters == 4 || times <= 1.0f)
            continue;
        // In this order what is not a number wants more.
        const std::uint32_t before = p.quarters;
        shade(p, times <= 2.0f ? 2 : 4);
        p.left *= float(before) / float(p.quarters);
        for (std::size_t i = p.begin; i < p.end; ++i)
            if (const std::uint32_t quarter = quarter_of(i); quarter >= before && quarter < p.quarters)
                second.push_back(i);
    }
    return second;
}

std::vector<SurfaceRounds::Again> SurfaceRounds::further(std::span<const float> even, const Found& found) {
    if (pixels_.empty() || !splits_)
        return {};
    std::ranges::for_each(pixels_, [&](Pixel& p) { measure(p, even, found); });
    std::vector<Again> again;
    for (Pixel& p : pixels_) {
        const auto [times, left] = wanted(p, 0.0f);
        p.left = left;
        if (p.quarters < 4 || times <= 1.0f)
            continue;
        // In this order what is not a number wants more.
        p.passes = times <= float(kMostPasses) ? static_cast<std::uint32_t>(std::ceil(times)) : kMostPasses;
        p.left /= float(p.passes);
        for (std::size_t i = p.begin; i < p.end; ++i)
            for (std::uint32_t pass = 1; pass < p.passes; ++pass)
                again.push_back({i, pass});
    }
    return again;
}

float SurfaceRounds::stands_for(std::size_t sample) const {
    const Pixel& p = pixels_[pixel_of_[sample]];
    return quarter_of(sample) < p.quarters ? p.scale / float(p.passes) : 0.0f;
}

double SurfaceRounds::variance_left() const {
    double sum = 0.0;
    for (const Pixel& p : pixels_)
        sum += std::isfinite(p.left) ? double(p.left) : 0.0;
    return sum;
}

}  // namespace brisance
