// The table of scattering methods, by name.
#pragma once

#include <string>
#include <vector>

#include "scattering_methods/list.h"

namespace brisance {

constexpr const char* kAutomaticMethod = "auto";
constexpr const char* kLightingGridMethod = "lighting_grid";

// Settings of all methods, and the choice among them.
struct ScatteringMethodSettings {
    template <class Method>
    struct Of;
    template <class... Methods>
    struct Of<std::tuple<Methods...>> {
        using Type = std::tuple<typename Methods::Settings...>;
    };

    std::string method = kAutomaticMethod;  // a name of scattering_method_names()
    Of<ScatteringMethodList>::Type of;

    template <class Settings>
    Settings& get() {
        return std::get<Settings>(of);
    }
    template <class Settings>
    const Settings& get() const {
        return std::get<Settings>(of);
    }
};

struct ScatteringMethod {
    std::string name;     // as scattering.method and as the section of its keys
    std::string product;  // what it makes, as users read it: "ray lights"
    std::string help;
    bool thins_lights;  // by what the camera sees: needs InScatteringRequest::receivers
    std::vector<MethodPreset> presets;
    int (*passes)(const ScatteringMethodSettings& settings);
    MadeInScattering (*make)(const InScatteringRequest& request, const ScatteringMethodSettings& settings);
};

const std::vector<ScatteringMethod>& scattering_methods();

// Null for the lighting grid, and for names of no method.
const ScatteringMethod* find_scattering_method(const std::string& name);

// "auto", "lighting_grid", and those of the table.
std::vector<std::string> scattering_method_names();

}  // namespace brisance
