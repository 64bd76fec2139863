// Selection of lights by resampling. The boxes of the tree do not show which of their lights almost touches the
// receiver. The tree therefore proposes several candidates for every light that is evaluated, and one of them is
// resampled by its own position (Talbot, Cline, Egbert, Importance Resampling for Global Illumination, EGSR 2005).
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

// Fills `choices` with up to `samples` lights. `target_of(light)`: target function of the resampling, about the light
// that arrives. Candidates are stratified over the tree; those of one sample lie apart.
template <class Light, class Target>
void resample_lights(const MediumLightTree& tree, std::span<const Light> lights, const LightReceiver& receiver,
                     int samples, const Target& target_of, Rng& rng, SelectionCost* cost,
                     std::vector<LightChoice<Light>>& choices) {
    constexpr int kCandidates = 8;  // that the tree proposes per evaluated light
    choices.clear();
    if (tree.empty())
        return;
    const int candidates = samples * kCandidates;
    const double shift = rng.next_double();
    for (int i = 0; i < samples; ++i) {
        double sum = 0.0, chosen_target = 0.0;
        const Light* chosen = nullptr;
        for (int k = 0; k < kCandidates; ++k) {
            const auto proposed = tree.choose(receiver, (i + samples * k + shift) / candidates);
            if (!proposed)
                continue;
            const Light& light = lights[proposed->light];
            const double target = target_of(light), weight = target / proposed->probability;
            sum += weight;
            if (weight > 0.0 && rng.next_double() * sum < weight) {
                chosen = &light;
                chosen_target = target;
            }
            if (cost)
                cost->visited += static_cast<std::uint64_t>(proposed->visited);
        }
        if (chosen)
            choices.push_back({chosen, sum / (chosen_target * kCandidates * samples)});
    }
    if (cost)
        cost->pairs += choices.size();
}

}  // namespace brisance
