// Gatherers that treat every point by itself: all lights, lights chosen one by one, and cuts at a vertex,
// which are those of virtual lights.
//
// Most lights of a fire in dense smoke reach no point at all. Cuts that count no smoke are all but blind there: they
// take the smoke between to be as dense as at the point. A random choice remains right whatever the guess is, and the
// guess falls off slowly (guessed_transmittance()); a deterministic cut may stop too early by it.
#pragma once

#include "emitters/weighted_choice.h"
#include "fire_lights/fire_lights.h"
#include "fire_lights/gather_points.h"
#include "fire_lights/settings.h"
#include "transport/lightcuts.h"
#include "transport/stochastic_lightcuts.h"

namespace brisance {

// At: made of lights and settings; at(point, rng) is what its vertex scatters.
template <class At>
class AtEachPoint : public FireGatherer {
public:
    AtEachPoint(const FireLights& lights, const FireLightSettings& settings) : each_(lights, settings) {}
    Rgb at(std::span<const GatherPoint> points, Rng& rng) const override {
        Rgb sum(0.0f);
        for (const GatherPoint& p : points)
            sum += p.weight * each_.at(p, rng);
        return sum;
    }
    std::uint64_t bytes() const override { return each_.bytes(); }

private:
    At each_;
};

class AllFireLights {
public:
    AllFireLights(const FireLights& lights, const FireLightSettings&) : lights_(lights) {}
    Rgb at(const GatherPoint& p, Rng& rng) const {
        Rgb sum(0.0f);
        for (std::size_t light = 0; light < lights_.size(); ++light)
            sum += lights_.estimate(light, 1.0, p.vertex, rng);
        return sum;
    }
    std::uint64_t bytes() const { return 0; }

private:
    const FireLights& lights_;
};

// In proportion to intensity (P. Shirley, C. Wang, K. Zimmerman, Monte Carlo Techniques for Direct Lighting
// Calculations, ACM Transactions on Graphics 15(1), 1996).
class FireByIntensity {
public:
    explicit FireByIntensity(const FireLights& lights) : choice_(lights.intensity()) {}
    std::optional<LightTree::Choice> choose(const PathVertex&, double u) const { return choice_.choose(u); }
    std::uint64_t bytes() const { return choice_.bytes(); }

private:
    WeightedChoice choice_;
};

// By the bounds of a light tree (emitters/light_tree.h).
class FireByTree {
public:
    explicit FireByTree(const FireLights& lights) : tree_(lights.bounds()) {}
    std::optional<LightTree::Choice> choose(const PathVertex& vertex, double u) const {
        return tree_.choose(vertex.lit(), u);
    }
    std::uint64_t bytes() const { return tree_.bytes(); }

private:
    LightTree tree_;
};

// settings.samples lights, stratified over the chooser's numbers.
template <class Chooser>
class ChosenFireLights {
public:
    ChosenFireLights(const FireLights& lights, const FireLightSettings& settings)
        : lights_(lights), chooser_(lights), samples_(settings.samples) {}
    Rgb at(const GatherPoint& p, Rng& rng) const {
        Rgb sum(0.0f);
        for (int i = 0; i < samples_; ++i)
            if (const auto choice = chooser_.choose(p.vertex, (i + rng.next_double()) / samples_))
                sum += lights_.estimate(choice->light, choice->probability * samples_, p.vertex, rng);
        return sum;
    }
    std::uint64_t bytes() const { return chooser_.bytes(); }

private:
    const FireLights& lights_;
    Chooser chooser_;
    int samples_;
};

class FireLightcuts {
public:
    FireLightcuts(const FireLights& lights, const FireLightSettings& s)
        : lights_(lights), cut_(LightTree(lights.bounds()), s.seed, s.lightcuts_error, s.lightcuts_most) {}
    Rgb at(const GatherPoint& p, Rng& rng) const {
        return cut_.at(
            p.vertex, [&](std::size_t light) { return lights_.estimate(light, 1.0, p.vertex, rng); }, p.extinction);
    }
    std::uint64_t bytes() const { return cut_.bytes(); }

private:
    const FireLights& lights_;
    Lightcut cut_;
};

class FireStochasticLightcuts {
public:
    FireStochasticLightcuts(const FireLights& lights, const FireLightSettings& s)
        : lights_(lights), cut_(LightTree(lights.bounds()), s.stochastic_cut_size) {}
    Rgb at(const GatherPoint& p, Rng& rng) const {
        return cut_.at(
            p.vertex, rng,
            [&](std::size_t light, double probability) { return lights_.estimate(light, probability, p.vertex, rng); },
            p.extinction);
    }
    std::uint64_t bytes() const { return cut_.bytes(); }

private:
    const FireLights& lights_;
    StochasticLightcut cut_;
};

}  // namespace brisance
