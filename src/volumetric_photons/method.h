// Volumetric photons as a row of the table of scattering methods (scattering_methods/list.h).
#pragma once

#include <vector>

#include "codec/setting_key.h"
#include "light_selection/in_scattering_method.h"
#include "volumetric_photons/settings.h"

namespace brisance {

struct VolumetricPhotonsMethod {
    using Settings = VolumetricPhotonSettings;
    static constexpr const char* kName = "volumetric_photons";
    static constexpr const char* kProduct = "volumetric photons";
    static constexpr const char* kHelp = "photons counted along their tracks and where they land, blurred over a voxel";
    static constexpr bool kThinsLights = false;  // it has no lights
    static std::vector<SettingKey<Settings>> keys();
    static std::vector<MethodPreset> presets() { return {{kName, {}}, {"photons_filtered", {"filter_radius=2"}}}; }
    static int passes(const Settings&) { return 1; }
    static MadeInScattering make(const InScatteringRequest& request, const Settings& settings);
};

}  // namespace brisance
