// Layers of an image as pictures that can be compared.
#pragma once

#include <string>
#include <vector>

#include "film/image.h"
#include "metrics/picture.h"

namespace brisance {

// Names of the layers that hold colour (R, G, B) or gray (Y). The beauty comes first and is called "" whatever its
// channels. Depth and coverage are left out.
std::vector<std::string> picture_layers(const Image& image);

// The sum of the named layers, which are among picture_layers; alpha is left out. Gray if any of them is.
struct LayerPicture {
    Picture picture;
    bool gray = false;
};
LayerPicture picture_of(const Image& image, const std::vector<std::string>& layers);

// Replaces every pixel by its Rec. 709 luminance, to compare it with a gray reference.
void to_gray(Picture& picture);

}  // namespace brisance
