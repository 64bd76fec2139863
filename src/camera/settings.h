// The pinhole camera of a shot.
#pragma once

#include <optional>
#include <vector>

#include "core/vec.h"

namespace brisance {

enum class PixelFilter { Box, Gaussian };

struct CameraSettings {
    // Looking from `eye` to `target`, or `world_from_camera` (x right, y up, looking along -z) which overrides them.
    dvec3 eye{0.0, 0.0, 1.0};
    dvec3 target{0.0};
    dvec3 up{0.0, 0.0, 1.0};
    std::optional<dmat4> world_from_camera;
    double vertical_fov_degrees = 35.0;
    int width = 1280;
    int height = 720;
    int samples_per_axis = 0;  // anti-aliasing samples along each side of a pixel; 0: as the voxels need
    int edge_refinement = 4;   // factor along a side where light has edges, with surfaces; 1: none
    PixelFilter filter = PixelFilter::Box;
    float filter_width_pixels = 1.0f;  // full width of the box, or four standard deviations of the Gaussian
};

enum class ShutterPosition { Start, Centre, End };

// Motion blur: for how long the shutter is open, and when.
struct ShutterSettings {
    double length = 0.5;                                 // [frames]; 0: no motion blur
    ShutterPosition position = ShutterPosition::Centre;  // of the frame in that time
    std::vector<vec2> curve;  // openness over the shutter's time from 0 to 1, linear between; empty: open throughout
    int most_moments = 16;    // at which a frame is drawn, however fast it moves
    int lighting_times = 1;   // moments for which light is computed; the others take the nearest
};

}  // namespace brisance
