// Every parameter of one image, each with its default.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera/settings.h"
#include "certificate/settings.h"
#include "correction/settings.h"
#include "film/settings.h"
#include "fire_lights/settings.h"
#include "gathering/settings.h"
#include "medium/settings.h"
#include "retiming/settings.h"
#include "scattering/settings.h"
#include "scattering_methods/methods.h"
#include "scene/settings.h"
#include "time_mapping/settings.h"
#include "tracking/settings.h"
#include "unified_lights/settings.h"
#include "virtual_lights/settings.h"
#include "volume/settings.h"

namespace brisance {

enum class RenderMethod {
    LightingGrid,  // many lights, lighting grid hierarchies
    Path,          // the reference path tracer
    Automatic      // whichever is likely to reach lighting.error sooner
};

// Its coefficients add to those of the shot's own volume.
struct FurtherVolume {
    VolumeSettings volume;
    MediumChanges changes;
    std::optional<TimeSettings> time;  // instead of the shot's
    std::optional<VelocitySettings> velocity;
};

struct Shot {
    std::string name;
    std::filesystem::path folder;  // relative files of the shot are relative to this folder
    VolumeSettings volume;
    std::vector<FurtherVolume> volumes;
    TimeSettings time;
    VelocitySettings velocity;
    MediumSettings medium;
    SceneSettings scene;
    CameraSettings camera;
    bool camera_given = false;    // false: framed on what there is, or a glTF file's
    bool exposure_given = false;  // false: chosen from the picture
    ShutterSettings shutter;
    RenderMethod method = RenderMethod::LightingGrid;
    double seconds = 0.0;  // of wall time for a frame, from which settings of least error follow; 0: as they are
    LightingSettings lighting;
    FireLightSettings fire_lights;
    UnifiedLightSettings unified_lights;
    ScatteringSettings scattering;
    ScatteringMethodSettings scattering_methods;
    VirtualLightSettings virtual_lights;
    TracingSettings tracing;
    CorrectionSettings correction;
    CertifySettings certify;
    OutputSettings output;
};

// As methods are compared: no paths of believed errors and automatic corrections count as the method's time.
inline Shot by_its_method_alone(Shot shot) {
    shot.certify.belief = 0.0;
    if (shot.correction.samples == kAutomaticCorrection)
        shot.correction.samples = 0;
    return shot;
}

}  // namespace brisance
