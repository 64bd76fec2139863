// Which virtual light a place asks, and in which direction.
#pragma once

#include <optional>
#include <vector>

#include "core/rng.h"
#include "emitters/light_tree.h"
#include "virtual_lights/settings.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

// Whether places ask by rays of their own.
inline bool draws_rays(LightSampling s) {
    return s == LightSampling::Bsdf || s == LightSampling::Combined || s == LightSampling::CombinedTree;
}

// Power and LightTree: of lights that camera paths placed by power per area, of those of photons by power, of relaxed
// ones all alike; or by the tree's bounds.
class LightChoice {
public:
    // Of lights whose power, intensity, area and spread are known. Nothing is built for Bsdf and All.
    LightChoice(const std::vector<VirtualLight>& lights, const VirtualLightSettings& settings);

    // From a number in [0, 1). None where no light can be of use.
    std::optional<LightTree::Choice> choose(const LitPoint& place, double u) const;
    double probability(const LitPoint& place, std::size_t light) const;

    bool by_lights() const { return by_tree_ || !cumulative_.empty(); }
    std::uint64_t bytes() const { return tree_.bytes() + cumulative_.size() * sizeof(double); }

private:
    bool by_tree_;
    std::vector<double> cumulative_;  // power, or power per area, inclusive; ends at 1
    LightTree tree_;
};

// A direction in which the light's sphere lies, evenly; from inside it any direction that the place can scatter from.
dvec3 sample_toward(const VirtualLight& light, const LitPoint& place, Rng& rng);
// Whether a direction leads into the sphere.
bool leads_into(const VirtualLight& light, const LitPoint& place, const dvec3& direction);
// Density [1/sr] of a direction that leads into the sphere.
double pdf_toward(const VirtualLight& light, const LitPoint& place, const dvec3& direction);

}  // namespace brisance
