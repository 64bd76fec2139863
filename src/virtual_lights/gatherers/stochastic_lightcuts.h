// Stochastic lightcuts of virtual lights (transport/stochastic_lightcuts.h), with settings.stochastic_cut_size.
#pragma once

#include "transport/stochastic_lightcuts.h"
#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/light_choosers.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

struct StochasticLightcuts {
    static constexpr const char* kNeeds = "any kind of light";

    template <VirtualLightKind Kind>
    class Of : public Gatherer {
    public:
        Of(const LightSet& set, LightImportance)
            : kind_(set),
              cut_(LightTree(bounds_of(set.lights, LobeBrightness::Mean)), set.settings().stochastic_cut_size,
                   LightLimits{bounds_of(set.lights, LobeBrightness::Mean),
                               least_squared_distances(set.lights, set.settings().point_bound)}) {}

        BoundedLight from_lights(const PathVertex& vertex, Rng& rng) const override {
            return cut_.at(vertex, rng, [&](std::size_t light, double probability) {
                return kind_.estimate(light, probability, vertex, rng);
            });
        }

        std::uint64_t bytes() const override { return cut_.bytes(); }

    private:
        Kind kind_;
        StochasticLightcut cut_;
    };
};

}  // namespace brisance
