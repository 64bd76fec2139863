// Resampled importance sampling, a reservoir of one: of several lights chosen by power one, by its unoccluded
// contribution.
//
// [1] J. Talbot, D. Cline, P. Egbert, Importance Resampling for Global Illumination, EGSR 2005.
// [2] B. Bitterli et al., Spatiotemporal Reservoir Resampling for Real-Time Ray Tracing with Dynamic Direct Lighting,
//     SIGGRAPH 2020: this is its first pass, without reuse from other pixels or frames.
//
// A candidate is a light and a direction toward it; the target is what that would contribute without occlusion. Where
// the target is 0 the contribution is 0 too, so that the mean is that of sampling one light.
#pragma once

#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/light_choosers.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

struct Resampled {
    static constexpr const char* kNeeds = "any kind of light";

    template <VirtualLightKind Kind>
    class Of : public Gatherer {
    public:
        Of(const LightSet& set, LightImportance importance)
            : kind_(set), chooser_(set.lights, importance), candidates_(set.settings().resampling_candidates) {}

        Rgb from_lights(const PathVertex& vertex, Rng& rng) const override {
            Candidate kept;
            double sum = 0.0;
            for (int i = 0; i < candidates_; ++i) {
                const Candidate drawn = candidate(vertex, rng);
                if (!(drawn.weight() > 0.0))
                    continue;
                sum += drawn.weight();
                if (rng.next_double() * sum < drawn.weight())
                    kept = drawn;
            }
            if (!(sum > 0.0))
                return Rgb(0.0f);
            return kind_.connect(kept.connection, vertex, static_cast<float>(sum / (candidates_ * kept.target)), rng);
        }

        std::uint64_t bytes() const override { return chooser_.bytes(); }

    private:
        struct Candidate {
            Connection connection;
            double density = 0.0;  // of light and direction
            double target = 0.0;   // luminance of what would be scattered

            double weight() const { return density > 0.0 ? target / density : 0.0; }
        };

        Candidate candidate(const PathVertex& vertex, Rng& rng) const {
            Candidate out;
            const std::optional<LightTree::Choice> choice = chooser_.choose(vertex.lit(), rng.next_double());
            if (!choice)
                return out;
            Connection& c = out.connection;
            c.light = choice->light;
            c.direction = kind_.sample(c.light, vertex, rng);
            out.density = choice->probability * kind_.pdf(c.light, vertex, c.direction);
            c.radiance = kind_.radiance(c.light, vertex, c.direction);
            if (c.radiance == Rgb(0.0f))
                return out;
            c.scattered = vertex.at(c.direction);
            out.target = luminance(c.scattered.value) * luminance(c.radiance);
            return out;
        }

        Kind kind_;
        PowerChooser chooser_;
        int candidates_;
    };
};

}  // namespace brisance
