// How far two pictures are apart in a layer.
#pragma once

#include <cmath>
#include <vector>

#include "film/image.h"

namespace brisance::testing {

// Root of the summed squared differences over that of the squares of `b`. An empty name is the picture.
inline double layer_difference(const Image& a, const Image& b, const char* layer = "") {
    const std::vector<float>&x = a.layer(layer).pixels, &y = b.layer(layer).pixels;
    double square = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        square += std::pow(double(x[i]) - y[i], 2);
        norm += double(y[i]) * y[i];
    }
    return std::sqrt(square / norm);
}

}  // namespace brisance::testing
