// What a ray of the camera sees up to the first surface.
#pragma once

#include <optional>

#include "render/integrate.h"

namespace brisance {

struct FirstLook {
    RaySum sum;                         // and what the surface emits, or the background
    std::optional<SurfaceHit> surface;  // where one is that may scatter light toward the camera
};

FirstLook first_look(const CellField& field, const PixelRay& ray, const PictureSettings& settings);

// Adds what one of a pixel's rays saw.
void add_weighted(RaySum& sum, const RaySum& s, float weight);

}  // namespace brisance
