// Gatherers that treat every point by itself, by the ways of transport/light_gathering.h.
//
// Most lights of a fire in dense smoke reach no point at all. Cuts that count no smoke are all but blind there: they
// take the smoke between to be as dense as at the point. A random choice remains right whatever the guess is, and the
// guess falls off slowly (guessed_transmittance()); a deterministic cut may stop too early by it.
#pragma once

#include "fire_lights/fire_lights.h"
#include "fire_lights/gather_points.h"
#include "fire_lights/settings.h"
#include "transport/light_gathering.h"

namespace brisance {

template <class Way>
class AtEachPoint : public FireGatherer {
public:
    AtEachPoint(const FireLights& lights, const FireLightSettings& settings)
        : lights_(lights), way_(lights, settings) {}
    Rgb at(std::span<const GatherPoint> points, Rng& rng) const override {
        Rgb sum(0.0f);
        for (const GatherPoint& p : points)
            sum += p.weight * way_.at(p.vertex, p.extinction, rng, [&](std::size_t light, double probability) {
                return lights_.estimate(light, probability, p.vertex, rng);
            });
        return sum;
    }
    std::uint64_t bytes() const override { return way_.bytes(); }

private:
    const FireLights& lights_;
    Way way_;
};

}  // namespace brisance
