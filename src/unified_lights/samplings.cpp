#include "unified_lights/samplings.h"

#include <algorithm>

#include "transport/multidimensional_lightcuts.h"

namespace brisance {

namespace {

template <class Way>
using AtEach = AtEachPoint<LightsOfAllKinds, Way>;

template <class Gatherer>
std::unique_ptr<UnifiedGatherer> made(const LightsOfAllKinds& lights, const UnifiedLightSettings& settings) {
    return std::make_unique<Gatherer>(lights, settings);
}

}  // namespace

const std::vector<UnifiedLightSampling>& unified_light_samplings() {
    static const std::vector<UnifiedLightSampling> table = {
        {"all", "every light", made<AtEach<EveryLight>>, true},
        {"intensity", "a light by intensity", made<AtEach<ChosenLights<ByIntensity>>>},
        {"light_tree", "a light by a tree of bounds", made<AtEach<ChosenLights<ByTree>>>},
        {"lightcuts", "one light for each node of a cut through a tree, the same for all points",
         made<AtEach<CutOfRepresentatives>>},
        {"stochastic_lightcuts", "a random light of each node of a small cut", made<AtEach<CutOfRandomLights>>},
        {"multidimensional_lightcuts", "one cut for all points of a ray and all lights",
         made<MultidimensionalLightcuts<LightsOfAllKinds>>}};
    return table;
}

const UnifiedLightSampling* find_unified_light_sampling(const std::string& name) {
    const auto& table = unified_light_samplings();
    const auto found = std::find_if(table.begin(), table.end(), [&](const auto& row) { return row.name == name; });
    return found == table.end() ? nullptr : &*found;
}

std::vector<std::string> unified_light_sampling_names() {
    std::vector<std::string> names = {kLightsApart};
    for (const UnifiedLightSampling& row : unified_light_samplings())
        names.emplace_back(row.name);
    return names;
}

}  // namespace brisance
