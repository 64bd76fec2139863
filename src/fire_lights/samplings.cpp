#include "fire_lights/samplings.h"

#include <algorithm>

#include "fire_lights/fire_lights.h"
#include "transport/multidimensional_lightcuts.h"

namespace brisance {

namespace {

template <class Way>
using AtEach = AtEachPoint<FireLights, Way>;

template <class Gatherer>
std::unique_ptr<FireGatherer> made(const FireLights& lights, const FireLightSettings& settings) {
    return std::make_unique<Gatherer>(lights, settings);
}

}  // namespace

const std::vector<FireLightSampling>& fire_light_samplings() {
    static const std::vector<FireLightSampling> table = {
        {"all", "every light, at every point", made<AtEach<EveryLight>>, true},
        {"intensity", "a light by intensity", made<AtEach<ChosenLights<ByIntensity>>>},
        {"light_tree", "a light by a tree of bounds", made<AtEach<ChosenLights<ByTree>>>},
        {"lightcuts", "one light for each node of a cut through a tree, the same for all points",
         made<AtEach<CutOfRepresentatives>>},
        {"stochastic_lightcuts", "a random light of each node of a small cut", made<AtEach<CutOfRandomLights>>},
        {"multidimensional_lightcuts", "one cut for all points of a ray and all lights",
         made<MultidimensionalLightcuts<FireLights>>}};
    return table;
}

const FireLightSampling* find_fire_light_sampling(const std::string& name) {
    const auto& table = fire_light_samplings();
    const auto found = std::find_if(table.begin(), table.end(), [&](const auto& row) { return row.name == name; });
    return found == table.end() ? nullptr : &*found;
}

std::vector<std::string> fire_light_sampling_names() {
    std::vector<std::string> names = {kFireByHierarchy};
    for (const FireLightSampling& row : fire_light_samplings())
        names.emplace_back(row.name);
    return names;
}

}  // namespace brisance
