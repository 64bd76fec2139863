// Separable filters: the product of a filter along the rows and one along the columns.
#pragma once

#include <cstddef>
#include <vector>

#include "core/parallel.h"
#include "metrics/picture.h"

namespace brisance {

// Weights of the offsets -radius ... radius.
using Taps = std::vector<float>;

// Sums of plane(x + i, y + j) across(i) down(j). Beyond the border the nearest pixel is repeated.
Plane filtered(const Plane& plane, const Taps& across, const Taps& down);

// Calls body(i) for every pixel, row by row in parallel.
template <class Body>
void for_each_pixel(int width, int height, const Body& body) {
    const auto row = static_cast<std::size_t>(width);
    parallel_for(static_cast<std::size_t>(height), [&](std::size_t y) {
        for (std::size_t i = y * row; i < (y + 1) * row; ++i)
            body(i);
    });
}

}  // namespace brisance
