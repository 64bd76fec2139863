// The pinhole camera of a shot.
#pragma once

#include <optional>

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

}  // namespace brisance
