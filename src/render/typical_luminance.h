// The luminance of what draws the eye: that of a picture, weighted by itself.
#pragma once

#include "camera_rays/picture.h"
#include "surface_lighting/surface_shader.h"

namespace brisance {

// <L^2> / <L> over the picture, to about a tenth [W/(m^2 sr)]. `settings` and `lighting`: those of the picture, from
// which this one has as many rays as it needs.
float typical_luminance(const Camera& camera, PictureSettings settings, SurfaceLightingInput lighting);

}  // namespace brisance
