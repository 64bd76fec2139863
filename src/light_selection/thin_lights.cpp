#include "light_selection/thin_lights.h"

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr std::size_t kBlock = 256;
constexpr double kByPowerAlone = 0.1;

// The common factor on all weights with which the probabilities min(1, factor * weight) add up to `count`.
double factor_for(std::vector<double> weights, double count) {
    std::sort(weights.begin(), weights.end(), std::greater<>());
    double rest = 0.0;
    for (const double w : weights)
        rest += w;
    // The largest weights become certain, one after another, until no more do.
    for (std::size_t certain = 0; certain < weights.size(); ++certain) {
        const double left = count - double(certain);
        if (left <= 0.0 || weights[certain] * left <= rest)
            return std::max(left, 0.0) / std::max(rest, 1e-300);
        rest -= weights[certain];
    }
    return 1e300;
}

}  // namespace

std::vector<double> survival_probabilities(std::span<const MediumLightBounds> lights,
                                           std::span<const LightReceiver> receivers, std::size_t count,
                                           double mean_cosine) {
    std::vector<double> chances(lights.size(), 0.0);
    parallel_for(
        lights.size(),
        [&](std::size_t i) {
            for (const LightReceiver& receiver : receivers)
                chances[i] += importance(lights[i], receiver, mean_cosine);
        },
        kBlock);
    double all_arriving = 0.0, all_power = 0.0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        all_arriving += chances[i];
        all_power += lights[i].scattered;
    }
    const double by_power = all_arriving > 0.0 ? kByPowerAlone : 1.0;
    for (std::size_t i = 0; i < lights.size(); ++i)
        chances[i] = by_power * lights[i].scattered / all_power +
                     (all_arriving > 0.0 ? (1.0 - by_power) * chances[i] / all_arriving : 0.0);
    const double factor = factor_for(chances, double(count));
    for (double& chance : chances)
        chance = std::min(1.0, factor * chance);
    return chances;
}

}  // namespace brisance
