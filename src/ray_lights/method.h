// Virtual ray lights as a row of the table of scattering methods (scattering_methods/list.h).
#pragma once

#include <vector>

#include "codec/setting_key.h"
#include "light_selection/in_scattering_method.h"
#include "ray_lights/settings.h"

namespace brisance {

struct RayLightsMethod {
    using Settings = RayLightSettings;
    static constexpr const char* kName = "ray_lights";
    static constexpr const char* kProduct = "ray lights";
    static constexpr const char* kHelp = "virtual ray lights, unbiased and noisy";
    static constexpr bool kThinsLights = true;  // for what the camera sees
    static std::vector<SettingKey<Settings>> keys();
    static std::vector<MethodPreset> presets() {
        return {{kName, {}}, {"ray_lights_tabulated", {"sampling=tabulated"}}, {"ray_beams", {"radius=auto"}}};
    }
    static int passes(const Settings& settings) { return settings.passes; }
    static MadeInScattering make(const InScatteringRequest& request, const Settings& settings);
};

}  // namespace brisance
