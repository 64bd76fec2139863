// Pixels that show one surface without textures: what its base reflects changes within them as slowly as the light.
#pragma once

#include <span>

#include "camera_rays/picture.h"
#include "scene/scene.h"

namespace brisance {

// Whether the rays of a pixel meet one triangle, or several of a mesh that together are nearly flat, of a material that
// is the same everywhere and scatters all light there, so that none of them is followed farther.
bool shows_plain_surface(const Scene& scene, std::span<const SurfaceSample> pixel);

}  // namespace brisance
