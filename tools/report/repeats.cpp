#include "repeats.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/still_variants.h"

namespace brisance {
namespace {

// Above the seeds that people choose, and a thousand repeats stay below the largest seed.
constexpr int kSeedsPerRepeat = 1048583;

struct Moments {
    double mean = 0.0;
    double deviation = 0.0;  // of one of them, with n - 1
};

template <class Measure>
Moments moments(std::span<const LayerErrors> repeats, const Measure& measure) {
    const auto count = static_cast<double>(repeats.size());
    Moments result;
    for (const LayerErrors& errors : repeats)
        result.mean += measure(errors) / count;
    for (const LayerErrors& errors : repeats)
        result.deviation += (measure(errors) - result.mean) * (measure(errors) - result.mean);
    result.deviation = repeats.size() > 1 ? std::sqrt(result.deviation / (count - 1.0)) : 0.0;
    return result;
}

}  // namespace

Shot shot_of_repeat(const Shot& shot, int repeat, const std::set<int>& taken) {
    if (repeat == 0)
        return shot;
    Shot other = reseeded(shot, repeat * kSeedsPerRepeat);
    while (other.method == RenderMethod::Path && taken.contains(other.tracing.seed))
        other = reseeded(other, 1);
    return other;
}

LayerErrors mean_errors(std::span<const LayerErrors> repeats, bool pictures_differ) {
    LayerErrors result = repeats.front();
    if (!pictures_differ)
        return result;
    ErrorSpread spread;
    const auto average = [&](const auto& measure) {
        const Moments of_measure = moments(repeats, measure);
        measure(result) = of_measure.mean;
        return of_measure.deviation;
    };
    spread.rrmse = average([](auto& e) -> auto& { return e.differences.rrmse; });
    spread.relmse = average([](auto& e) -> auto& { return e.differences.relmse; });
    spread.mape = average([](auto& e) -> auto& { return e.differences.mape; });
    spread.mean = average([](auto& e) -> auto& { return e.differences.mean; });
    spread.flip = average([](auto& e) -> auto& { return e.flip; });
    if (result.noise_free)
        spread.noise_free = average([](auto& e) -> auto& { return *e.noise_free; });
    for (const LayerErrors& errors : repeats) {
        result.not_finite.image = std::max(result.not_finite.image, errors.not_finite.image);
        result.not_finite.reference = std::max(result.not_finite.reference, errors.not_finite.reference);
        result.below_noise = result.below_noise || errors.below_noise;
    }
    result.spread = spread;
    return result;
}

Cost median_cost(std::span<const Cost> repeats) {
    std::vector<Cost> costs(repeats.begin(), repeats.end());
    const auto middle = costs.begin() + static_cast<std::ptrdiff_t>((costs.size() - 1) / 2);
    std::nth_element(costs.begin(), middle, costs.end(),
                     [](const Cost& a, const Cost& b) { return a.wall_seconds < b.wall_seconds; });
    return *middle;
}

}  // namespace brisance
