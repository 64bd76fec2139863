// Reduces the lights to those that matter to the camera.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/rng.h"
#include "geometry/intersector.h"
#include "light_selection/medium_light_tree.h"

namespace brisance {

struct Thinning {
    std::size_t count = 0;  // of lights that are kept, about
    double mean_cosine = 0.0;
    const Intersector* occluders = nullptr;  // surfaces that may hide lights from receivers; null: they hide none
    Stream stream = {};                      // of the roulette
    std::uint32_t seed = 0;
};

// Survival probability of every light, such that about `count` survive: proportional to its share of the light at the
// receivers (Georgiev and Slusallek, Simple and Robust Iterative Importance Sampling of Virtual Point Lights,
// Eurographics 2010). A tenth is by power alone, for points that no receiver represents. With occluders the share is
// multiplied by the part of it that is not hidden, as a few lines tell that are drawn by it; a ninth at least, since
// they may all have missed a gap.
std::vector<double> survival_probabilities(std::span<const MediumLightBounds> lights,
                                           std::span<const LightReceiver> receivers, const Thinning& how);

// Keeps about `count` of the lights by Russian roulette with those probabilities, weighted so that the expected power
// is unchanged. Keeps all lights if there are no more than `count`.
template <class Light>
std::vector<Light> thin_lights(std::vector<Light> lights, std::span<const LightReceiver> receivers,
                               const Thinning& how) {
    if (lights.size() <= how.count)
        return lights;
    const std::vector<double> chances = survival_probabilities(boxes_of(lights), receivers, how);
    std::vector<Light> kept;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!(Rng(how.stream, i, how.seed).next_double() < chances[i]))
            continue;
        kept.push_back(lights[i]);
        kept.back().power /= float(chances[i]);
        kept.back().scattered /= chances[i];
    }
    return kept;
}

// The part of all lights that is kept; 1 where there are none.
inline double acceptance(std::uint64_t kept, std::uint64_t all) {
    return all > 0 ? double(kept) / double(all) : 1.0;
}

}  // namespace brisance
