#include "fire_lights/samplings.h"
#include "shot/keys/keys.h"

namespace brisance {

namespace {

Codec<std::string> sampling_codec() {
    std::vector<std::pair<std::string, std::string>> words;
    for (const std::string& name : fire_light_sampling_names())
        words.emplace_back(name, name);
    return choice<std::string>(words);
}

std::string sampling_help() {
    std::string help = std::string(kFireByHierarchy) + ": lighting grid hierarchies, without noise";
    for (const FireLightSampling& row : fire_light_samplings())
        help += std::string("; ") + row.name + ": " + row.help;
    return help;
}

}  // namespace

void add_fire_light_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "fire_lights.sampling", sampling_help(), sampling_codec(),
        [](Shot & s) -> auto& { return s.fire_lights.sampling; }));
    keys.push_back(make_key(
        "fire_lights.points", "on every ray of the camera through smoke at which light is gathered; of a surface, one",
        whole(1, 65536), [](Shot & s) -> auto& { return s.fire_lights.points; }));
    keys.push_back(make_key(
        "fire_lights.samples", "for sampling intensity and light_tree: lights at every point", whole(1, 65536),
        [](Shot & s) -> auto& { return s.fire_lights.samples; }));
    keys.push_back(make_key(
        "fire_lights.lightcuts_error",
        "for sampling lightcuts and multidimensional_lightcuts: what a node of the cut may err, over the sum of all",
        real(Range{0.0, 1.0}), [](Shot & s) -> auto& { return s.fire_lights.lightcuts_error; }));
    keys.push_back(make_key(
        "fire_lights.lightcuts_most",
        "for sampling lightcuts: the most nodes of the cut of a point; multidimensional_lightcuts: of a whole ray, or "
        "a point of a surface",
        whole(1, 100000000), [](Shot & s) -> auto& { return s.fire_lights.lightcuts_most; }));
    keys.push_back(make_key(
        "fire_lights.stochastic_cut_size", "for sampling stochastic_lightcuts: nodes of the cut, one light of each",
        whole(1, 1000000), [](Shot & s) -> auto& { return s.fire_lights.stochastic_cut_size; }));
    keys.push_back(make_key(
        "fire_lights.seed", "another number gives other points and lights", whole(0, 2147483647),
        [](Shot & s) -> auto& { return s.fire_lights.seed; }));
}

}  // namespace brisance
