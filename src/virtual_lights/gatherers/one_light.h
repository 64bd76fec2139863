// One light per vertex, chosen by a LightChooser.
#pragma once

#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/light_choosers.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

template <LightChooser Chooser>
struct OneLight {
    static constexpr const char* kNeeds = "any kind of light";

    template <VirtualLightKind Kind>
    class Of : public Gatherer {
    public:
        Of(const LightSet& set, LightImportance importance) : kind_(set), chooser_(set.lights, importance) {}

        Rgb from_lights(const PathVertex& vertex, Rng& rng) const override {
            const std::optional<LightTree::Choice> choice = chooser_.choose(vertex.lit(), rng.next_double());
            return choice ? kind_.estimate(choice->light, choice->probability, vertex, rng) : Rgb(0.0f);
        }

        std::uint64_t bytes() const override { return chooser_.bytes(); }

    private:
        Kind kind_;
        Chooser chooser_;
    };
};

}  // namespace brisance
