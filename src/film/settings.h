// Settings of a frame's output files.
#pragma once

#include <string>

namespace brisance {

enum class ViewTransform { Filmic, Srgb };

struct OutputSettings {
    std::string path;                            // EXR; frame tokens as in VolumeSettings::file
    bool png = true;                             // beside the EXR, same stem
    bool statistics = true;                      // JSON beside the EXR, same stem
    bool cell_layers = true;                     // one layer per ledger cell
    bool bounce_layers = false;                  // one layer per scattering order
    bool bound_layers = false;                   // SS in two parts, and what the bound of virtual point lights takes
    bool halves = false;                         // STEM.A.exr and STEM.B.exr beside the EXR, where there are any
    bool virtual_lights = false;                 // STEM.virtual_lights.*: pictures of the many-light method's lights
    float exposure_stops = 0.0f;                 // of the PNG only
    ViewTransform view = ViewTransform::Filmic;  // of the PNG only
    double frames_per_second = 0.0;              // recorded in the EXR; 0: not recorded
};

}  // namespace brisance
