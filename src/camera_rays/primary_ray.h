// A primary ray: light up to the first surface.
#pragma once

#include <optional>

#include "camera_rays/picture.h"

namespace brisance {

struct PrimaryRay {
    RaySum sum;                         // includes the emission of the surface or the background
    std::optional<SurfaceHit> surface;  // if it may scatter light toward the camera
};

PrimaryRay trace_primary_ray(const SourceField& field, const PixelRay& ray, const PictureSettings& settings);

// Adds the result of one of a pixel's rays.
void add_weighted(RaySum& sum, const RaySum& s, float weight);

}  // namespace brisance
