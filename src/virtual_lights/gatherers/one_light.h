// Lights chosen by a LightChooser, settings.light_samples of them at every vertex.
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
        Of(const LightSet& set, LightImportance importance)
            : kind_(set), chooser_(set.lights, importance), samples_(set.settings().light_samples) {}

        BoundedLight from_lights(const PathVertex& vertex, Rng& rng) const override {
            BoundedLight sum;
            for (int i = 0; i < samples_; ++i)
                if (const std::optional<LightTree::Choice> choice = chooser_.choose(vertex.lit(), rng.next_double()))
                    sum += kind_.estimate(choice->light, choice->probability, vertex, rng);
            return samples_ > 1 ? sum / float(samples_) : sum;
        }

        std::uint64_t bytes() const override { return chooser_.bytes(); }

    private:
        Kind kind_;
        Chooser chooser_;
        int samples_;
    };
};

}  // namespace brisance
