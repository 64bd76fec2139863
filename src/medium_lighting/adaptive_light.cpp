#include "medium_lighting/adaptive_light.h"

#include "core/parallel.h"

namespace brisance {

namespace {

// Multiplies every field by a factor per node and colour.
template <class FactorAt>
void multiply(Gathered& light, std::size_t nodes, const FactorAt& factor_at) {
    for (std::vector<float>* field : {&light.fluence, &light.scattered, &light.moments})
        parallel_for(
            nodes,
            [&](std::size_t i) {
                const Rgb factor = factor_at(i);
                for (std::size_t plane = 0; plane * nodes < field->size(); ++plane)
                    (*field)[plane * nodes + i] *= factor[int(plane % 3)];
            },
            4096);
}

}  // namespace

void AdaptiveLight::conserve(const std::vector<std::uint8_t>& as_it_is) {
    if (conserving.empty())
        return;
    multiply(light, conserving.size(),
             [&](std::size_t i) { return Rgb(!as_it_is.empty() && as_it_is[i] ? 1.0f : conserving[i]); });
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
    Rgb of_gathered(1.0f), of_interpolated(1.0f);
    for (int c = 0; c < 3; ++c) {
        const float part = all[c] > 0.0 ? float(here[c] / all[c]) : 1.0f;
        of_gathered[c] = 1.0f + (scale[c] - 1.0f) * part;
        of_interpolated[c] = 1.0f + (scale[c] - 1.0f) * (1.0f + part);
    }
    multiply(light.light, fluence.size(),
             [&](std::size_t i) { return glm::mix(of_interpolated, of_gathered, light.gathered[i]); });
}

}  // namespace brisance
