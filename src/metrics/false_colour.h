// A map of errors as colours.
#pragma once

#include <cstdint>
#include <vector>

#include "metrics/picture.h"

namespace brisance {

// 8-bit sRGB, three numbers per pixel, of errors in [0, 1]; what lies outside is clipped. Black is 0; CIELAB lightness
// rises in proportion to the error, so that equal steps look equal and the map can be read in gray, while the hue goes
// from violet over red to pale yellow.
std::vector<std::uint8_t> false_colours(const Plane& errors);

}  // namespace brisance
