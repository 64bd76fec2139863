// The pictures that the measures compare: linear colour alone, whatever channels a file has.
#pragma once

#include <vector>

#include "core/vec.h"

namespace brisance {

// Linear Rec. 709, rows from the top. Gray is three equal numbers: every measure is then that of the one channel.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels;
};

// One number per pixel, rows from the top.
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<float> values;
};

}  // namespace brisance
