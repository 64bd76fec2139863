// Reduces the lights to those that matter to the camera.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/rng.h"
#include "light_selection/medium_light_tree.h"

namespace brisance {

// Survival probability of every light, such that about `count` survive: proportional to its share of the light at the
// receivers (Georgiev and Slusallek, Simple and Robust Iterative Importance Sampling of Virtual Point Lights,
// Eurographics 2010). A tenth is by power alone, for points that no receiver represents.
std::vector<double> survival_probabilities(std::span<const MediumLightBounds> lights,
                                           std::span<const LightReceiver> receivers, std::size_t count,
                                           double mean_cosine);

// Keeps about `count` of the lights by Russian roulette with those probabilities, weighted so that the expected power
// is unchanged. Keeps all lights if there are no more than `count`.
template <class Light>
std::vector<Light> thin_lights(std::vector<Light> lights, std::span<const LightReceiver> receivers, std::size_t count,
                               double mean_cosine, Stream stream, std::uint32_t seed) {
    if (lights.size() <= count)
        return lights;
    const std::vector<double> chances = survival_probabilities(boxes_of(lights), receivers, count, mean_cosine);
    std::vector<Light> kept;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!(Rng(stream, i, seed).next_double() < chances[i]))
            continue;
        kept.push_back(lights[i]);
        kept.back().power /= float(chances[i]);
        kept.back().scattered /= chances[i];
    }
    return kept;
}

}  // namespace brisance
