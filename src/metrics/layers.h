// Layers of an image as pictures that can be compared.
#pragma once

#include <string>
#include <vector>

#include "film/image.h"
#include "metrics/picture.h"

namespace brisance {

// Layers that hold colour (R, G, B) or gray (Y), the beauty first and called "" whatever its channels. Depth and
// coverage are none.
std::vector<std::string> picture_layers(const Image& image);

// The sum of the named layers, which are among picture_layers; alpha is left out. Gray as soon as one of them is.
struct LayerPicture {
    Picture picture;
    bool gray = false;
};
LayerPicture picture_of(const Image& image, const std::vector<std::string>& layers);

// Every pixel becomes its Rec. 709 luminance: what a gray reference is compared with.
void to_gray(Picture& picture);

}  // namespace brisance
