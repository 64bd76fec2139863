// Traces more rays for pixels that contain the edge of a light source.
//
// A lamp, the sun in a puddle or a flame may be thousands of times brighter than its neighbourhood. The fraction of a
// pixel that it covers then determines the pixel, and the rays that shade surfaces are far too few to estimate it.
// Tracing costs little compared with shading. Where directly visible fire, emitters and background jump between
// neighbouring rays, many more rays are therefore traced, and their result replaces that of the pixel's own rays. What
// changes evenly within a pixel is known from its own rays and is not traced again. The light of surfaces is kept.
#pragma once

#include <vector>

#include "camera_rays/picture_writer.h"
#include "camera_rays/pixel_rays.h"

namespace brisance {

// `glare`: of every pixel, in rows. `writer`: holds the finished picture.
void refine_edges(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                  const std::vector<Glare>& glare, PictureWriter& writer);

}  // namespace brisance
