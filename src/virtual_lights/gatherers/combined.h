// One light, chosen by a LightChooser, and one ray sampled by BSDF or phase function, weighted by the balance heuristic
// (E. Veach, L. Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, SIGGRAPH 1995).
#pragma once

#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/light_choosers.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

template <LightChooser Chooser>
struct Combined {
    static constexpr const char* kNeeds = kHittable;

    template <Hittable Kind>
    class Of : public Gatherer {
    public:
        Of(const LightSet& set, LightImportance importance) : kind_(set), chooser_(set.lights, importance) {}

        BoundedLight from_lights(const PathVertex& vertex, Rng& rng) const override {
            const std::optional<LightTree::Choice> choice = chooser_.choose(vertex.lit(), rng.next_double());
            if (!choice)
                return {};
            Connection connection{choice->light, kind_.sample(choice->light, vertex, rng), {}, {}};
            connection.scattered = vertex.at(connection.direction);
            if (connection.scattered.value == Rgb(0.0f))
                return {};
            const double pdf = choice->probability * kind_.pdf(choice->light, vertex, connection.direction);
            const double density = pdf + connection.scattered.pdf;
            return density > 0.0 ? kind_.incident(connection, vertex, rng) / float(density) : Rgb(0.0f);
        }

        Rgb from_ray(const PathVertex& vertex, const CoveredHit& hit, double pdf) const override {
            Rgb sum(0.0f);
            for (int i = 0; i < hit.shares.count; ++i) {
                const std::size_t light = hit.shares.light[i];
                const double other =
                    chooser_.probability(vertex.lit(), light) * kind_.pdf(light, vertex, hit.segment.ray.direction);
                sum += kind_.radiance_at(hit, i) * float(pdf / (pdf + other));
            }
            return sum;
        }

        std::uint64_t bytes() const override { return chooser_.bytes(); }

    private:
        Kind kind_;
        Chooser chooser_;
    };
};

}  // namespace brisance
