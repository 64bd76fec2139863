// Virtual lights one by one, of whatever kind: for those who choose among them together with other lights. Each light
// costs one call, which is little beside its shadow ray.
#pragma once

#include <memory>

#include "virtual_lights/kinds/kind.h"

namespace brisance {

class SingleLights {
public:
    virtual ~SingleLights() = default;
    // Of what the vertex scatters of that light, over the probability of having chosen it [W/(m^2 sr)]. With
    // probability 1, all lights add up to what a gatherer without rays by BSDF estimates.
    virtual BoundedLight estimate(std::size_t light, double probability, const PathVertex& vertex, Rng& rng) const = 0;
};

template <VirtualLightKind Kind>
class SingleLightsOf : public SingleLights {
public:
    explicit SingleLightsOf(const LightSet& set) : kind_(set) {}
    BoundedLight estimate(std::size_t light, double probability, const PathVertex& vertex, Rng& rng) const override {
        return kind_.estimate(light, probability, vertex, rng);
    }

private:
    Kind kind_;
};

template <VirtualLightKind Kind>
std::unique_ptr<SingleLights> single_lights_of(const LightSet& set) {
    return std::make_unique<SingleLightsOf<Kind>>(set);
}

}  // namespace brisance
