#include "scattering_methods/methods.h"

#include <algorithm>

namespace brisance {

namespace {

template <class Method>
ScatteringMethod row() {
    using Settings = typename Method::Settings;
    return {Method::kName,
            Method::kProduct,
            Method::kHelp,
            Method::kThinsLights,
            Method::presets(),
            [](const ScatteringMethodSettings& s) { return Method::passes(s.get<Settings>()); },
            [](const InScatteringRequest& request, const ScatteringMethodSettings& s) {
                return Method::make(request, s.get<Settings>());
            }};
}

template <class... Methods>
std::vector<ScatteringMethod> rows(std::tuple<Methods...>) {
    return {row<Methods>()...};
}

}  // namespace

const std::vector<ScatteringMethod>& scattering_methods() {
    static const std::vector<ScatteringMethod> table = rows(ScatteringMethodList{});
    return table;
}

const ScatteringMethod* find_scattering_method(const std::string& name) {
    const auto& table = scattering_methods();
    const auto found = std::find_if(table.begin(), table.end(), [&](const auto& m) { return m.name == name; });
    return found == table.end() ? nullptr : &*found;
}

std::vector<std::string> scattering_method_names() {
    std::vector<std::string> names = {kAutomaticMethod, kLightingGridMethod};
    for (const ScatteringMethod& method : scattering_methods())
        names.push_back(method.name);
    return names;
}

}  // namespace brisance
