#include "independent_draw.h"

#include <algorithm>
#include <cassert>

namespace brisance {
namespace {

constexpr int kMargin = 1;

}

Shot drawn_independently(Shot shot) {
    assert(shot.camera_given);
    shot.camera.width += 2 * kMargin;  // the field of view is the vertical one
    return shot;
}

Picture without_margin(const Picture& picture) {
    Picture inner{picture.width - 2 * kMargin, picture.height, {}};
    inner.pixels.reserve(static_cast<std::size_t>(inner.width) * static_cast<std::size_t>(inner.height));
    for (int y = 0; y < inner.height; ++y) {
        const auto row = picture.pixels.begin() + std::ptrdiff_t{y} * picture.width + kMargin;
        inner.pixels.insert(inner.pixels.end(), row, row + inner.width);
    }
    return inner;
}

}  // namespace brisance
