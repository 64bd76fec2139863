// Small pictures made from functions.
#pragma once

#include <functional>

#include "metrics/picture.h"

namespace brisance::testing {

inline Picture make_picture(int width, int height, const std::function<Rgb(int, int)>& colour) {
    Picture picture{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            picture.pixels.push_back(colour(x, y));
    return picture;
}

inline Picture even_picture(float gray, int width = 32, int height = 24) {
    return make_picture(width, height, [&](int, int) { return Rgb(gray); });
}

// What pixel (x, y) of the result is, is pixel `from(x, y)` of the picture.
template <class From>
Picture rearranged(const Picture& picture, int width, int height, const From& from) {
    return make_picture(width, height, [&](int x, int y) {
        const auto [there_x, there_y] = from(x, y);
        return picture.pixels[static_cast<std::size_t>(there_y * picture.width + there_x)];
    });
}

inline float at(const Plane& plane, int x, int y) {
    return plane.values[static_cast<std::size_t>(y * plane.width + x)];
}

}  // namespace brisance::testing
