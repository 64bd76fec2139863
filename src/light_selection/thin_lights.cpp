#include "light_selection/thin_lights.h"

#include "core/parallel.h"
#include "light_selection/joint_sampling.h"

namespace brisance {

namespace {

constexpr std::size_t kBlock = 256;
constexpr double kByPowerAlone = 0.1;

// Lines from a light that tell how much of it surfaces hide.
constexpr int kLines = 8;
// The ends of such a line are not tested: surfaces may lie there.
constexpr double kEndOfLine = 1e-3;
constexpr Stream kLinesOfLights = stream_of("light_selection/lines of lights");

// A point that the light at `from` reaches by the inverse square.
dvec3 point_on(const LightReceiver& receiver, const dvec3& from, Rng& rng) {
    if (!receiver.is_ray)
        return receiver.point;
    return receiver.ray.length > 0.0 ? receiver.ray.at(AngularDensity(from, receiver.ray, {}).sample(rng))
                                     : receiver.ray.start;
}

bool hidden(const Intersector& occluders, const dvec3& from, const dvec3& to) {
    const double distance = glm::distance(from, to);
    if (!(distance > 0.0))
        return false;
    const dvec3 direction = (to - from) / distance;
    return occluders.occluded({from + kEndOfLine * distance * direction, direction},
                              (1.0 - 2.0 * kEndOfLine) * distance);
}

// Of what reaches the receivers. `up_to`: running sums of the light's share at each of them.
double part_not_hidden(const Intersector& occluders, const MediumLightBounds& light,
                       std::span<const LightReceiver> receivers, const std::vector<double>& up_to, Rng& rng) {
    const dvec3 from = 0.5 * (light.low + light.high);
    int clear = 0;
    for (int k = 0; k < kLines; ++k) {
        const double number = (k + rng.next_double()) / kLines * up_to.back();
        const auto at = std::upper_bound(up_to.begin(), up_to.end() - 1, number) - up_to.begin();
        clear += hidden(occluders, from, point_on(receivers[std::size_t(at)], from, rng)) ? 0 : 1;
    }
    return (clear + 1.0) / (kLines + 1.0);
}

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
                                           std::span<const LightReceiver> receivers, const Thinning& how) {
    std::vector<double> chances(lights.size(), 0.0);
    parallel_for(
        lights.size(),
        [&](std::size_t i) {
            thread_local std::vector<double> up_to;
            up_to.clear();
            for (const LightReceiver& receiver : receivers)
                up_to.push_back(chances[i] += importance(lights[i], receiver, how.mean_cosine));
            if (how.occluders && chances[i] > 0.0) {
                Rng rng(kLinesOfLights, i, how.seed);
                chances[i] *= part_not_hidden(*how.occluders, lights[i], receivers, up_to, rng);
            }
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
    const double factor = factor_for(chances, double(how.count));
    for (double& chance : chances)
        chance = std::min(1.0, factor * chance);
    return chances;
}

}  // namespace brisance
