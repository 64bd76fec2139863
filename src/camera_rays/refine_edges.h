// Traces more rays for pixels that contain the edge of a light source.
//
// A lamp, the sun in a puddle or a flame may be thousands of times brighter than its neighbourhood. The fraction of a
// pixel that it covers then determines the pixel, and the rays that shade surfaces are far too few to estimate it.
// Tracing costs little compared with shading. Where directly visible fire, emitters and background differ strongly
// within a pixel or between it and its neighbours, many more rays are therefore traced, and their result replaces that
// of the pixel's own rays. The light of surfaces is kept.
#pragma once

#include <vector>

#include "camera/pixel_samples.h"
#include "camera_rays/picture_writer.h"

namespace brisance {

// Luminance of directly visible emission (cells V and A) over the rays of a pixel [W/(m^2 sr)].
struct Glare {
    float least = std::numeric_limits<float>::infinity(), most = 0.0f;

    void add(const CellSum& seen);
};

// `glare`: of every pixel, in rows, as `samples` saw it. `writer`: holds the finished picture.
void refine_edges(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                  const std::vector<PixelSample>& samples, const std::vector<Glare>& glare, PictureWriter& writer);

}  // namespace brisance
