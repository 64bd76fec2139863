// One light, chosen by a LightChooser, and one ray sampled by BSDF or phase function, weighted by the balance heuristic
// (E. Veach, L. Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, SIGGRAPH 1995).
//
// Lights overlap: where a ray toward one of them ends, up to eight lights hold what is reflected. All of it is taken,
// over the density with which any of these lights leads there: each is one technique of many, and the balance heuristic
// weights them too. A light alone would bring a share between 0 and 1 that depends on where its sphere was hit.
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
        Of(const LightSet& set, LightImportance importance) : set_(set), kind_(set), chooser_(set.lights, importance) {}

        BoundedLight from_lights(const PathVertex& vertex, Rng& rng) const override {
            const std::optional<LightTree::Choice> choice = chooser_.choose(vertex.lit(), rng.next_double());
            if (!choice)
                return {};
            Connection connection{choice->light, kind_.sample(choice->light, vertex, rng), {}, {}};
            connection.scattered = vertex.at(connection.direction);
            if (connection.scattered.value == Rgb(0.0f))
                return {};
            Rgb found(0.0f);
            kind_.meet(connection, vertex, [&](const CoveredHit& hit, double terminated) {
                const double density = connection.scattered.pdf + density_of_lights(vertex, hit);
                if (!(density > 0.0))
                    return;
                const double seen = set_.scene().lines().transmittance(hit.segment.ray, hit.segment.end, rng);
                found = connection.scattered.value * radiance_at(hit) * float(seen * terminated / density);
            });
            return found;
        }

        Rgb from_ray(const PathVertex& vertex, const CoveredHit& hit, double pdf) const override {
            return radiance_at(hit) * float(pdf / (pdf + density_of_lights(vertex, hit)));
        }

        std::uint64_t bytes() const override { return chooser_.bytes(); }

    private:
        // Of all lights there [W/(m^2 sr)].
        Rgb radiance_at(const CoveredHit& hit) const {
            Rgb sum(0.0f);
            for (int i = 0; i < hit.shares.count; ++i)
                sum += kind_.radiance_at(hit, i);
            return sum;
        }

        // With which lights are sampled that cover the hit, toward it [1/sr].
        double density_of_lights(const PathVertex& vertex, const CoveredHit& hit) const {
            double sum = 0.0;
            for (int i = 0; i < hit.shares.count; ++i) {
                const std::size_t light = hit.shares.light[i];
                sum += chooser_.probability(vertex.lit(), light) * kind_.pdf(light, vertex, hit.segment.ray.direction);
            }
            return sum;
        }

        const LightSet& set_;
        Kind kind_;
        Chooser chooser_;
    };
};

}  // namespace brisance
