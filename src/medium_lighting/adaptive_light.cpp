#include "medium_lighting/adaptive_light.h"

#include <algorithm>

#include "core/parallel.h"

namespace brisance {

void AdaptiveLight::conserve(const std::vector<std::uint8_t>& as_it_is) {
    const auto planes = light.planes();
    parallel_for(
        conserving.size(),
        [&](std::size_t i) {
            for (std::size_t c = 0; c < planes.size() && (as_it_is.empty() || !as_it_is[i]); ++c)
                planes[c][i] *= conserving[i];
        },
        4096);
}

void balance_light(const LitLattice& lattice, const ScatteredLight& lights, AdaptiveLight& light,
                   BounceBalance& balance) {
    std::vector<Rgb> fluence = fluence_at_nodes(light.light, lattice.needed());
    for (std::size_t i = 0; i < light.conserving.size(); ++i)
        fluence[i] *= light.conserving[i];
    const Rgb scale = energy_balance_factor(lattice.pyramid(), lights, fluence, balance);
    if (light.gathered.empty())
        return light.light.scale(scale);
    const dvec3 all = collided_power(lattice.medium(), fluence);
    for (std::size_t i = 0; i < fluence.size(); ++i)
        fluence[i] *= light.gathered[i];
    const dvec3 here = collided_power(lattice.medium(), fluence);
    Rgb of_all(1.0f), of_interpolated(1.0f);
    for (int c = 0; c < 3; ++c) {
        const float part = all[c] > 0.0 ? float(here[c] / all[c]) : 1.0f;
        of_all[c] = 1.0f + (scale[c] - 1.0f) * part;
        of_interpolated[c] = std::max(0.0f, 1.0f + (scale[c] - 1.0f) * (1.0f + part));
    }
    light.light.scale(of_all);
    const float ratio = luminance(of_interpolated / of_all);
    for (std::size_t i = 0; i < light.conserving.size(); ++i)
        light.conserving[i] *= glm::mix(ratio, 1.0f, light.gathered[i]);
}

}  // namespace brisance
