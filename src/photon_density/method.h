// Density estimation by photon points and beams as a row of the table of scattering methods
// (scattering_methods/list.h).
#pragma once

#include <vector>

#include "codec/setting_key.h"
#include "light_selection/in_scattering_method.h"
#include "photon_density/settings.h"

namespace brisance {

struct PhotonDensityMethod {
    using Settings = PhotonDensitySettings;
    static constexpr const char* kName = "photon_density";
    static constexpr const char* kProduct = "photon points and beams";
    static constexpr const char* kHelp = "photon points or photon beams around each ray, blurred over a radius";
    static constexpr bool kThinsLights = false;  // all photons are seen
    static std::vector<SettingKey<Settings>> keys();
    static std::vector<MethodPreset> presets();
    static int passes(const Settings& settings) { return settings.passes; }
    static MadeInScattering make(const InScatteringRequest& request, const Settings& settings);
};

}  // namespace brisance
