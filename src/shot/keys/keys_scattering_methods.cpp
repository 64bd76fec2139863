// scattering.method, and a section of keys for each method of the table.
#include "shot/keys/keys.h"

namespace brisance {

namespace {

Codec<std::string> method_codec() {
    std::vector<std::pair<std::string, std::string>> words;
    for (const std::string& name : scattering_method_names())
        words.emplace_back(name, name);
    return choice<std::string>(words);
}

std::string method_help() {
    std::string help = std::string(kLightingGridMethod) + ": hierarchies of scattered light, without noise; ";
    for (const ScatteringMethod& method : scattering_methods())
        help += method.name + ": " + method.help + "; ";
    return help + kAutomaticMethod + ": " + VolumetricPhotonsMethod::kName +
           " for thin smoke whose phase function has a sharp peak, " + kLightingGridMethod +
           " otherwise, and mixtures between";
}

// One key of a method's settings as a key of the shot.
template <class Settings>
Key key_of_shot(const std::string& section, const SettingKey<Settings>& key) {
    return {
        section + "." + key.name,
        key.help,
        key.expected,
        key.schema,
        [set = key.set](Shot& shot, const Json& json) { return set(shot.scattering_methods.get<Settings>(), json); },
        [get = key.get](const Shot& shot) -> std::optional<Json> {
            return get(shot.scattering_methods.get<Settings>());
        }};
}

template <class... Methods>
void add_keys_of(std::tuple<Methods...>, std::vector<Key>& keys) {
    const auto add = [&]<class Method>(Method) {
        for (const auto& key : Method::keys())
            keys.push_back(key_of_shot(Method::kName, key));
    };
    (add(Methods{}), ...);
}

}  // namespace

void add_scattering_method_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "scattering.method", method_help(), method_codec(),
        [](Shot & s) -> auto& { return s.scattering_methods.method; }));
    add_keys_of(ScatteringMethodList{}, keys);
}

}  // namespace brisance
