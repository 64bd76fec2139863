// Many lights to fewer: those that the camera will ask for.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/rng.h"
#include "light_selection/medium_light_tree.h"

namespace brisance {

// With which probability every light stays, so that about `count` do: by its share of what arrives at the receivers
// (Georgiev and Slusallek, Simple and Robust Iterative Importance Sampling of Virtual Point Lights, Eurographics 2010).
// A tenth of it is by power alone, for what no receiver stands for.
std::vector<double> survival_probabilities(std::span<const MediumLightBounds> lights,
                                           std::span<const LightReceiver> receivers, std::size_t count,
                                           double mean_cosine);

// Keeps about `count` of the lights, by Russian roulette with those probabilities; those that stay carry the light of
// those that go. Nothing to do where there are no more than `count`.
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
