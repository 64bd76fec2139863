// Traces more rays for pixels that contain the edge of a light source.
//
// A lamp, the sun in a puddle or a flame may be thousands of times brighter than its neighbourhood. The fraction of a
// pixel that it covers then determines the pixel, and the rays that shade surfaces are far too few to estimate it.
// Tracing costs little compared with shading. Where directly visible fire, emitters and background jump between
// neighbouring rays, many more rays are therefore traced, and their result replaces that of the pixel's own rays. What
// changes evenly within a pixel is known from its own rays and is not traced again. The light of surfaces is kept.
#pragma once

#include <span>
#include <vector>

#include "camera/pixel_samples.h"
#include "camera_rays/picture_writer.h"

namespace brisance {

// Luminance of directly visible emission (cells V and A) over the rays of a pixel [W/(m^2 sr)].
struct Glare {
    float least = 0.0f, most = 0.0f;
    float step = 0.0f;  // largest difference between neighbouring rays
};

float direct_luminance(const CellSum& seen);

// Of the luminances that the rays of pixel_samples() saw, in their order.
Glare glare_of(std::span<const float> luminances);

// `glare`: of every pixel, in rows, as `samples` saw it. `writer`: holds the finished picture.
void refine_edges(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                  const std::vector<PixelSample>& samples, const std::vector<Glare>& glare, PictureWriter& writer);

}  // namespace brisance
