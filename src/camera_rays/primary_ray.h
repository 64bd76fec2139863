// A primary ray: what the camera sees up to the first surface.
#pragma once

#include <optional>

#include "camera_rays/picture.h"

namespace brisance {

struct PrimaryRay {
    RaySum sum;                         // and what the surface emits, or the background
    std::optional<SurfaceHit> surface;  // where one is that may scatter light toward the camera
};

PrimaryRay trace_primary_ray(const SourceField& field, const PixelRay& ray, const PictureSettings& settings);

// Adds what one of a pixel's rays saw.
void add_weighted(RaySum& sum, const RaySum& s, float weight);

}  // namespace brisance
