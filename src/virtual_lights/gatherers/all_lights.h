// Every light, at every vertex: no noise of choice, at a price. The mean that all other gatherers must have.
#pragma once

#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

struct AllLights {
    static constexpr const char* kNeeds = "any kind of light";

    template <VirtualLightKind Kind>
    class Of : public Gatherer {
    public:
        Of(const LightSet& set, LightImportance) : kind_(set), lights_(set.lights.size()) {}

        BoundedLight from_lights(const PathVertex& vertex, Rng& rng) const override {
            BoundedLight sum;
            for (std::size_t light = 0; light < lights_; ++light)
                sum += kind_.estimate(light, 1.0, vertex, rng);
            return sum;
        }

    private:
        Kind kind_;
        std::size_t lights_;
    };
};

}  // namespace brisance
