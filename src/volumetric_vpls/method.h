// Volumetric virtual point lights as a row of the table of scattering methods (scattering_methods/list.h).
#pragma once

#include <vector>

#include "codec/setting_key.h"
#include "light_selection/in_scattering_method.h"
#include "volumetric_vpls/settings.h"

namespace brisance {

struct VolumetricVplsMethod {
    using Settings = VolumetricVplSettings;
    static constexpr const char* kName = "volumetric_vpls";
    static constexpr const char* kProduct = "volumetric virtual point lights";
    static constexpr const char* kHelp = "virtual point lights where particles collide, bounded and compensated";
    static constexpr bool kThinsLights = true;  // by what the camera sees
    static std::vector<SettingKey<Settings>> keys();
    static std::vector<MethodPreset> presets();
    static int passes(const Settings&) { return 1; }
    static MadeInScattering make(const InScatteringRequest& request, const Settings& settings);
};

}  // namespace brisance
