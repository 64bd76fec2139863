// Which lights are asked: the tree, whose boxes cannot know which of their lights almost touches the receiver, proposes
// a few for every one that is asked, and one of them is resampled by its own place (Talbot, Cline, Egbert, Importance
// Resampling for Global Illumination, EGSR 2005).
#pragma once

#include <span>
#include <vector>

#include "core/rng.h"
#include "light_selection/in_scattering.h"
#include "light_selection/medium_light_tree.h"

namespace brisance {

template <class Light>
struct LightChoice {
    const Light* light;
    double weight;  // over the number of samples
};

// Fills `choices` with up to `samples` lights. `wanted_of(light)`: about what it sends, for resampling. Candidates are
// stratified over the tree; those of one sample lie apart.
template <class Light, class Wanted>
void resample_lights(const MediumLightTree& tree, std::span<const Light> lights, const LightReceiver& receiver,
                     int samples, const Wanted& wanted_of, Rng& rng, SelectionCost* cost,
                     std::vector<LightChoice<Light>>& choices) {
    constexpr int kCandidates = 8;  // that the tree proposes for one light that is asked
    choices.clear();
    if (tree.empty())
        return;
    const int candidates = samples * kCandidates;
    const double shift = rng.next_double();
    for (int i = 0; i < samples; ++i) {
        double sum = 0.0, target = 0.0;
        const Light* chosen = nullptr;
        for (int k = 0; k < kCandidates; ++k) {
            const auto proposed = tree.choose(receiver, (i + samples * k + shift) / candidates);
            if (!proposed)
                continue;
            const Light& light = lights[proposed->light];
            const double wanted = wanted_of(light), weight = wanted / proposed->probability;
            sum += weight;
            if (weight > 0.0 && rng.next_double() * sum < weight) {
                chosen = &light;
                target = wanted;
            }
            if (cost)
                cost->visited += static_cast<std::uint64_t>(proposed->visited);
        }
        if (chosen)
            choices.push_back({chosen, sum / (target * kCandidates * samples)});
    }
    if (cost)
        cost->pairs += choices.size();
}

}  // namespace brisance
