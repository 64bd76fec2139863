// Values of a picture's pixels, and its pyramid: halved, and smooth between.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "core/parallel.h"

namespace brisance {

template <class T>
struct Plane {
    int width = 0, height = 0;
    std::vector<T> values;
    Plane() = default;
    Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h), T(0.0f)) {}
    T* row(int y) { return values.data() + std::size_t(y) * std::size_t(width); }
    const T* row(int y) const { return values.data() + std::size_t(y) * std::size_t(width); }
};

template <class Body>
void for_rows(int rows, const Body& body) {
    parallel_for(
        std::size_t(rows), [&](std::size_t y) { body(static_cast<int>(y)); }, 8);
}

inline int half_of(int size) {
    return (size + 1) / 2;
}

// Binomial weights over five pixels, nothing beyond the border; every second pixel. `at`: the value of a pixel, by
// column and row.
template <class At>
auto reduced(int width, int height, const At& at) {
    using T = std::decay_t<decltype(at(0, 0))>;
    constexpr float kBinomial[] = {1.0f / 16.0f, 4.0f / 16.0f, 6.0f / 16.0f, 4.0f / 16.0f, 1.0f / 16.0f};
    Plane<T> narrow(half_of(width), height), out(half_of(width), half_of(height));
    for_rows(height, [&](int y) {
        for (int x = 0; x < narrow.width; ++x)
            for (int k = -2; k <= 2; ++k)
                if (const int from = 2 * x + k; from >= 0 && from < width)
                    narrow.row(y)[x] += kBinomial[k + 2] * at(from, y);
    });
    for_rows(out.height, [&](int y) {
        for (int k = -2; k <= 2; ++k)
            if (const int from = 2 * y + k; from >= 0 && from < height)
                for (int x = 0; x < out.width; ++x)
                    out.row(y)[x] += kBinomial[k + 2] * narrow.row(from)[x];
    });
    return out;
}

template <class T>
Plane<T> reduced(const Plane<T>& from) {
    return reduced(from.width, from.height, [&](int x, int y) { return from.row(y)[x]; });
}

// The inverse of halving: a smooth curve near the values of the coarse level, by the same weights.
template <class T>
Plane<T> expanded(const Plane<T>& from, int width, int height) {
    const auto between = [](int x, int count, const auto& at) {
        const int i = std::min(x / 2, count - 1), next = std::min(i + 1, count - 1);
        if (x % 2 == 1)
            return 0.5f * (at(i) + at(next));
        return 0.75f * at(i) + 0.125f * (at(std::max(i - 1, 0)) + at(next));
    };
    Plane<T> wide(width, from.height), out(width, height);
    for_rows(wide.height, [&](int y) {
        for (int x = 0; x < width; ++x)
            wide.row(y)[x] = between(x, from.width, [&](int i) { return from.row(y)[i]; });
    });
    for_rows(height, [&](int y) {
        for (int x = 0; x < width; ++x)
            out.row(y)[x] = between(y, from.height, [&](int i) { return wide.row(i)[x]; });
    });
    return out;
}

}  // namespace brisance
