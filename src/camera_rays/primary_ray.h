// A primary ray: light up to the first surface.
#pragma once

#include <optional>

#include "camera_rays/picture.h"

namespace brisance {

struct PrimaryRay {
    RaySum sum;                         // includes the emission of the surface or the background
    std::optional<SurfaceHit> surface;  // if it may scatter light toward the camera
};

// `hit`: of the ray with the surroundings of the settings.
PrimaryRay trace_primary_ray(const SourceField& field, const PixelRay& ray, const std::optional<SurfaceHit>& hit,
                             const PictureSettings& settings);

// Its two parts: light of the medium up to the surface hit, and what a ray sees there through a medium of transmittance
// `through`: that surface, or the background.
RaySum medium_along(const SourceField& field, const PixelRay& ray, const std::optional<SurfaceHit>& hit,
                    const PictureSettings& settings);
void add_end(const Surroundings& surroundings, const Ray& ray, const std::optional<SurfaceHit>& hit, float through,
             RaySum& sum);

// Adds the result of one of a pixel's rays.
void add_weighted(RaySum& sum, const RaySum& s, float weight);

}  // namespace brisance
