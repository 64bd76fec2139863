// More rays for pixels in which something that shines has an edge.
//
// A lamp, the sun in a puddle or a flame may be thousands of times brighter than what is beside it: what part of a
// pixel it fills then decides the pixel, and the rays that shade surfaces are far too few to tell. Looking costs little
// of what shading does. So where fire, emitters and background that are seen directly differ strongly within a pixel or
// from those beside it, many more rays look, and what they see takes the place of what the pixel's own rays saw;
// surfaces keep the light of those.
#pragma once

#include <vector>

#include "camera/pixel_samples.h"
#include "camera_rays/picture_writer.h"

namespace brisance {

// Luminance of what shines by itself (cells V and A), over the rays of a pixel [W/(m^2 sr)].
struct Glare {
    float least = std::numeric_limits<float>::infinity(), most = 0.0f;

    void add(const CellSum& seen);
};

// `glare`: of every pixel, in rows, as `samples` saw it. `writer`: holds the finished picture.
void refine_edges(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                  const std::vector<PixelSample>& samples, const std::vector<Glare>& glare, PictureWriter& writer);

}  // namespace brisance
