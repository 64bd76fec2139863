// Traces more rays for pixels whose own were too few.
//
// Edges of light sources. A lamp, the sun in a puddle or a flame may be thousands of times brighter than its
// neighbourhood. The fraction of a pixel that it covers then determines the pixel, and the rays that shade surfaces are
// far too few to estimate it. Tracing costs little compared with shading. Where directly visible fire, emitters and
// background jump between neighbouring rays, many more rays are therefore traced, and their result replaces that of
// the pixel's own rays. What changes evenly within a pixel is known from its own rays and is not traced again.
//
// Smoke. A pixel is a mean over its area. Rays at the centres of its n * n cells have that mean where light changes
// evenly. Where it bends, they err: by a 24th of its second difference over cells if it is a parabola, by up to an
// eighth if it has a kink. Smoke is therefore seen by few rays at first, and by as many as its voxels want where the
// differences between pixels tell that those few err by more than is tolerated.
//
// The light of surfaces is kept.
#pragma once

#include <vector>

#include "camera_rays/picture_writer.h"
#include "camera_rays/pixel_rays.h"

namespace brisance {

// What a pixel's own rays saw.
struct FirstLook {
    Glare glare;
    float medium = 0.0f;   // luminance of the cells of light from the medium [W/(m^2 sr)]
    float through = 0.0f;  // transmittance of the medium, mean of the rays
};

// Whether a picture with these settings looks again, and needs what its pixels saw first.
bool looks_again(const PictureSettings& settings);

// `first`: of every pixel, in rows. `writer`: holds the finished picture.
void look_again(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                const std::vector<FirstLook>& first, PictureWriter& writer);

}  // namespace brisance
