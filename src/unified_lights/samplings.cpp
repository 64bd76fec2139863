#include "unified_lights/samplings.h"

#include <algorithm>

#include "transport/light_gathering.h"

namespace brisance {

namespace {

template <class Way>
class ByWay : public UnifiedGatherer {
public:
    ByWay(const LightsOfAllKinds& lights, const UnifiedLightSettings& settings)
        : lights_(lights), way_(lights, settings) {}
    LightBySender at(const UnifiedReceiver& receiver, Rng& rng) const override {
        const double extinction = lights_.extinction_at(receiver.vertex.position());
        return way_.at(receiver.vertex, extinction, rng, [&](std::size_t light, double probability) {
            return lights_.estimate(light, probability, receiver, rng);
        });
    }
    std::uint64_t bytes() const override { return way_.bytes(); }

private:
    const LightsOfAllKinds& lights_;
    Way way_;
};

template <class Way>
std::unique_ptr<UnifiedGatherer> made(const LightsOfAllKinds& lights, const UnifiedLightSettings& settings) {
    return std::make_unique<ByWay<Way>>(lights, settings);
}

}  // namespace

const std::vector<UnifiedLightSampling>& unified_light_samplings() {
    static const std::vector<UnifiedLightSampling> table = {
        {"all", "every light", made<EveryLight>, true},
        {"intensity", "a light by intensity", made<ChosenLights<ByIntensity>>},
        {"light_tree", "a light by a tree of bounds", made<ChosenLights<ByTree>>},
        {"lightcuts", "one light for each node of a cut through a tree, the same for all points",
         made<CutOfRepresentatives>},
        {"stochastic_lightcuts", "a random light of each node of a small cut", made<CutOfRandomLights>}};
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
