#include "medium_lighting/adaptive_light.h"

#include <algorithm>

#include "core/parallel.h"

namespace brisance {

void AdaptiveLight::conserve(const std::vector<float>& kept) {
    const auto planes = light.planes();
    parallel_for(
        conserving.size(),
        [&](std::size_t i) {
            const float factor = kept.empty() ? conserving[i] : glm::mix(1.0f, conserving[i], kept[i]);
            for (const auto& plane : planes)
                plane[i] *= factor;
        },
        4096);
}

void balance_light(const LitLattice& lattice, const ScatteredLight& lights, AdaptiveLight& light,
                   BounceBalance& balance) {
    std::vector<Rgb> fluence = fluence_at_nodes(light.light, lattice.needed());
    for (std::size_t i = 0; i < light.conserving.size(); ++i)
        fluence[i] *= light.conserving[i];
    const BalanceFactors factors = energy_balance_factors(lattice.pyramid(), lights, fluence, light.gathered, balance);
    light.light.scale(factors.gathered);
    const float ratio = luminance(factors.rest) / luminance(factors.gathered);
    for (std::size_t i = 0; i < light.conserving.size(); ++i)
        light.conserving[i] *= glm::mix(ratio, 1.0f, light.gathered.share[i]);
}

}  // namespace brisance
