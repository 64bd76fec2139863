// Lightcuts of virtual lights (transport/lightcuts.h), with settings.lightcuts_error and settings.lightcuts_most.
#pragma once

#include "transport/lightcuts.h"
#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/light_choosers.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

struct Lightcuts {
    static constexpr const char* kNeeds = "any kind of light";

    template <VirtualLightKind Kind>
    class Of : public Gatherer {
    public:
        Of(const LightSet& set, LightImportance)
            : kind_(set),
              cut_(LightTree(bounds_of(set.lights, LobeBrightness::Peak)), set.settings().seed,
                   set.settings().lightcuts_error, set.settings().lightcuts_most,
                   LightLimits{bounds_of(set.lights, LobeBrightness::Peak),
                               least_squared_distances(set.lights, set.settings().point_bound)}) {}

        BoundedLight from_lights(const PathVertex& vertex, Rng& rng) const override {
            return cut_.at(vertex, [&](std::size_t light) { return kind_.estimate(light, 1.0, vertex, rng); });
        }

        std::uint64_t bytes() const override { return cut_.bytes(); }

    private:
        Kind kind_;
        Lightcut cut_;
    };
};

}  // namespace brisance
