// Choosing one of many lights for a path vertex, with a known probability.
#pragma once

#include <concepts>
#include <optional>
#include <vector>

#include "emitters/light_tree.h"
#include "emitters/weighted_choice.h"
#include "virtual_lights/placement/placement.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

// Virtual lights as a light tree sees them: the boxes of their spheres, their cones, and their largest intensities.
std::vector<LightBounds> bounds_of(const std::vector<VirtualLight>& lights, LobeBrightness lobes);

// At which each of them counts as being, however near it is (LightLimits::least2): the bound of points, or its own
// radiance where it has a surface [m^2].
std::vector<double> least_squared_distances(const std::vector<VirtualLight>& lights, double point_bound);

// Made of lights whose power, intensity, area and spread are known.
template <class Chooser>
concept LightChooser = requires(const Chooser& chooser, const std::vector<VirtualLight>& lights,
                                LightImportance importance, const LitPoint& point, double u, std::size_t light) {
    Chooser(lights, importance);
    // From a number in [0, 1). None where no light can contribute.
    { chooser.choose(point, u) } -> std::same_as<std::optional<LightTree::Choice>>;
    // With which choose() picks that light.
    { chooser.probability(point, light) } -> std::same_as<double>;
    { chooser.bytes() } -> std::same_as<std::uint64_t>;
};

// In proportion to the placement's importance, the same at every vertex.
class PowerChooser {
public:
    PowerChooser(const std::vector<VirtualLight>& lights, LightImportance importance);
    std::optional<LightTree::Choice> choose(const LitPoint&, double u) const { return choice_.choose(u); }
    double probability(const LitPoint&, std::size_t light) const { return choice_.probability(light); }
    std::uint64_t bytes() const { return choice_.bytes(); }

private:
    WeightedChoice choice_;
};

// In proportion to power, whatever the placement: intensity sampling (P. Shirley, C. Wang, K. Zimmerman, Monte Carlo
// Techniques for Direct Lighting Calculations, ACM Transactions on Graphics 15(1), 1996).
class PlainPowerChooser : public PowerChooser {
public:
    PlainPowerChooser(const std::vector<VirtualLight>& lights, LightImportance) : PowerChooser(lights, power_alone) {}
};

// All alike.
class UniformChooser {
public:
    UniformChooser(const std::vector<VirtualLight>& lights, LightImportance) : count_(lights.size()) {}
    std::optional<LightTree::Choice> choose(const LitPoint& point, double u) const;
    double probability(const LitPoint&, std::size_t) const { return 1.0 / double(count_); }
    std::uint64_t bytes() const { return 0; }

private:
    std::size_t count_;
};

// By the bounds of a light tree on what each light sends to the vertex.
class TreeChooser {
public:
    TreeChooser(const std::vector<VirtualLight>& lights, LightImportance);
    std::optional<LightTree::Choice> choose(const LitPoint& point, double u) const { return tree_.choose(point, u); }
    double probability(const LitPoint& point, std::size_t light) const { return tree_.probability(point, light); }
    std::uint64_t bytes() const { return tree_.bytes(); }

private:
    LightTree tree_;
};

}  // namespace brisance
