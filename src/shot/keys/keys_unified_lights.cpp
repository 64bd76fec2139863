#include "shot/keys/keys.h"
#include "unified_lights/samplings.h"

namespace brisance {

namespace {

Codec<std::string> sampling_codec() {
    std::vector<std::pair<std::string, std::string>> words;
    for (const std::string& name : unified_light_sampling_names())
        words.emplace_back(name, name);
    return choice<std::string>(words);
}

std::string sampling_help() {
    std::string help = std::string(kLightsApart) + ": each kind of light has its own choice";
    for (const UnifiedLightSampling& row : unified_light_samplings())
        help += std::string("; ") + row.name + ": " + row.help;
    return help;
}

}  // namespace

void add_unified_light_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "unified_lights.sampling", sampling_help(), sampling_codec(),
        [](Shot & s) -> auto& { return s.unified_lights.sampling; }));
    keys.push_back(make_key(
        "unified_lights.smoke",
        "also in smoke, along the camera's rays; false: on surfaces alone, and fire_lights.sampling chooses in smoke",
        flag(), [](Shot & s) -> auto& { return s.unified_lights.smoke; }));
    keys.push_back(make_key(
        "unified_lights.points",
        "on every ray of the camera through smoke at which light is gathered; of a surface, one", whole(1, 65536),
        [](Shot & s) -> auto& { return s.unified_lights.points; }));
    keys.push_back(make_key(
        "unified_lights.samples", "for sampling intensity and light_tree: lights at every point", whole(1, 65536),
        [](Shot & s) -> auto& { return s.unified_lights.samples; }));
    keys.push_back(make_key(
        "unified_lights.lightcuts_error",
        "for sampling lightcuts and multidimensional_lightcuts: what a node of the cut may err, over the sum of all "
        "lights of all kinds",
        real(Range{0.0, 1.0}), [](Shot & s) -> auto& { return s.unified_lights.lightcuts_error; }));
    keys.push_back(make_key(
        "unified_lights.lightcuts_most",
        "for sampling lightcuts and multidimensional_lightcuts: the most nodes of a cut, of a point or of a whole ray",
        whole(1, 100000000), [](Shot & s) -> auto& { return s.unified_lights.lightcuts_most; }));
    keys.push_back(make_key(
        "unified_lights.stochastic_cut_size", "for sampling stochastic_lightcuts: nodes of the cut, one light of each",
        whole(1, 1000000), [](Shot & s) -> auto& { return s.unified_lights.stochastic_cut_size; }));
    keys.push_back(make_key(
        "unified_lights.seed", "another number gives other lights", whole(0, 2147483647),
        [](Shot & s) -> auto& { return s.unified_lights.seed; }));
}

}  // namespace brisance
