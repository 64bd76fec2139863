// Ways to gather the light of many lights at one vertex, whatever the lights are: every light, lights chosen one by
// one, and cuts through a tree. What they know of the lights are bounds; whoever owns the lights estimates one of them.
//
// All are made of the lights and of settings with the members that they name. `Lights` has size(), intensity(), the
// weights of a choice by intensity, and bounds(LobeBrightness). All have
//   at(vertex, extinction, rng, estimate)
// the light of all lights. estimate(light, probability): of one, over the probability with which it was chosen; Rgb or
// what adds up and has a luminance() likewise. `extinction`: of smoke that cuts take to be all around the vertex [1/m].
#pragma once

#include <type_traits>

#include "emitters/weighted_choice.h"
#include "transport/lightcuts.h"
#include "transport/stochastic_lightcuts.h"

namespace brisance {

// Of lights that know least_squared_distances() (LightLimits::least2).
template <class Lights>
LightLimits limits_of(const Lights& lights, LobeBrightness lobes) {
    if constexpr (requires { lights.least_squared_distances(); })
        return {lights.bounds(lobes), lights.least_squared_distances()};
    else
        return {};
}

template <class Estimate>
using EstimatedLight = std::invoke_result_t<const Estimate&, std::size_t, double>;

class EveryLight {
public:
    template <class Lights, class Settings>
    EveryLight(const Lights& lights, const Settings&) : count_(lights.size()) {}

    template <class Estimate>
    EstimatedLight<Estimate> at(const PathVertex&, double, Rng&, const Estimate& estimate) const {
        auto sum = EstimatedLight<Estimate>(Rgb(0.0f));
        for (std::size_t light = 0; light < count_; ++light)
            sum += estimate(light, 1.0);
        return sum;
    }
    std::uint64_t bytes() const { return 0; }

private:
    std::size_t count_;
};

// In proportion to intensity (P. Shirley, C. Wang, K. Zimmerman, Monte Carlo Techniques for Direct Lighting
// Calculations, ACM Transactions on Graphics 15(1), 1996).
class ByIntensity {
public:
    template <class Lights>
    explicit ByIntensity(const Lights& lights) : choice_(lights.intensity()) {}
    std::optional<LightTree::Choice> choose(const PathVertex&, double u) const { return choice_.choose(u); }
    std::uint64_t bytes() const { return choice_.bytes(); }

private:
    WeightedChoice choice_;
};

// By the bounds of a light tree (emitters/light_tree.h).
class ByTree {
public:
    template <class Lights>
    explicit ByTree(const Lights& lights) : tree_(lights.bounds(LobeBrightness::Mean)) {}
    std::optional<LightTree::Choice> choose(const PathVertex& vertex, double u) const {
        return tree_.choose(vertex.lit(), u);
    }
    std::uint64_t bytes() const { return tree_.bytes(); }

private:
    LightTree tree_;
};

// settings.samples lights, stratified over the chooser's numbers.
template <class Chooser>
class ChosenLights {
public:
    template <class Lights, class Settings>
    ChosenLights(const Lights& lights, const Settings& settings) : chooser_(lights), samples_(settings.samples) {}

    template <class Estimate>
    EstimatedLight<Estimate> at(const PathVertex& vertex, double, Rng& rng, const Estimate& estimate) const {
        auto sum = EstimatedLight<Estimate>(Rgb(0.0f));
        for (int i = 0; i < samples_; ++i)
            if (const auto choice = chooser_.choose(vertex, (i + rng.next_double()) / samples_))
                sum += estimate(choice->light, choice->probability * samples_);
        return sum;
    }
    std::uint64_t bytes() const { return chooser_.bytes(); }

private:
    Chooser chooser_;
    int samples_;
};

// settings.lightcuts_error, settings.lightcuts_most and settings.seed.
class CutOfRepresentatives {
public:
    template <class Lights, class Settings>
    CutOfRepresentatives(const Lights& lights, const Settings& s)
        : cut_(LightTree(lights.bounds(LobeBrightness::Peak)), s.seed, s.lightcuts_error, s.lightcuts_most,
               limits_of(lights, LobeBrightness::Peak)) {}

    template <class Estimate>
    EstimatedLight<Estimate> at(const PathVertex& vertex, double extinction, Rng&, const Estimate& estimate) const {
        return cut_.at(
            vertex, [&](std::size_t light) { return estimate(light, 1.0); }, extinction);
    }
    std::uint64_t bytes() const { return cut_.bytes(); }

private:
    Lightcut cut_;
};

// settings.stochastic_cut_size.
class CutOfRandomLights {
public:
    template <class Lights, class Settings>
    CutOfRandomLights(const Lights& lights, const Settings& s)
        : cut_(LightTree(lights.bounds(LobeBrightness::Mean)), s.stochastic_cut_size,
               limits_of(lights, LobeBrightness::Mean)) {}

    template <class Estimate>
    EstimatedLight<Estimate> at(const PathVertex& vertex, double extinction, Rng& rng, const Estimate& estimate) const {
        return cut_.at(vertex, rng, estimate, extinction);
    }
    std::uint64_t bytes() const { return cut_.bytes(); }

private:
    StochasticLightcut cut_;
};

}  // namespace brisance
