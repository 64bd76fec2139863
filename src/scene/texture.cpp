#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/srgb.h"

namespace brisance {
namespace {

const std::array<float, 256> kLinearFromByte = [] {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = linear_from_srgb(static_cast<float>(i) / 255.0f);
    return table;
}();

// Where `coordinate` falls after wrapping by whole pictures, 0 to 1 (Repeat), 0 to 2 (Mirror), or clamped; doing that
// before it is multiplied by the size keeps texels exact far out. What is not finite is 0.
double reduced(float coordinate, Wrap wrap) {
    const double c = coordinate;
    if (!std::isfinite(c))
        return 0.0;
    if (wrap == Wrap::Clamp)
        return std::clamp(c, -1.0, 2.0);
    const double period = wrap == Wrap::Mirror ? 2.0 : 1.0;
    return c - period * std::floor(c / period);
}

int wrapped(int texel, int size, Wrap wrap) {
    if (wrap == Wrap::Clamp)
        return std::clamp(texel, 0, size - 1);
    const int period = wrap == Wrap::Mirror ? 2 * size : size;
    texel = ((texel % period) + period) % period;
    return texel < size ? texel : period - 1 - texel;
}

vec4 texel_at(const Texture& texture, int x, int y) {
    const std::size_t i =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) + static_cast<std::size_t>(x));
    if (!texture.floats.empty()) {
        const float* const f = &texture.floats[i];
        if (texture.srgb)
            return {linear_from_srgb(f[0]), linear_from_srgb(f[1]), linear_from_srgb(f[2]), f[3]};
        return {f[0], f[1], f[2], f[3]};
    }
    const std::uint8_t* const b = &texture.bytes[i];
    if (texture.srgb)
        return {kLinearFromByte[b[0]], kLinearFromByte[b[1]], kLinearFromByte[b[2]], static_cast<float>(b[3]) / 255.0f};
    return vec4(b[0], b[1], b[2], b[3]) / 255.0f;
}

}  // namespace

vec4 Texture::at(vec2 uv) const {
    // Texel i covers i to i + 1, its centre is at i + 0.5.
    const double x = reduced(uv.x, wrap_u) * width, y = reduced(uv.y, wrap_v) * height;
    if (nearest)
        return texel_at(*this, wrapped(static_cast<int>(std::floor(x)), width, wrap_u),
                        wrapped(static_cast<int>(std::floor(y)), height, wrap_v));
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const auto right_share = static_cast<float>(x - 0.5 - left), bottom_share = static_cast<float>(y - 0.5 - top);
    const int x0 = wrapped(static_cast<int>(left), width, wrap_u);
    const int x1 = wrapped(static_cast<int>(left) + 1, width, wrap_u);
    const int y0 = wrapped(static_cast<int>(top), height, wrap_v);
    const int y1 = wrapped(static_cast<int>(top) + 1, height, wrap_v);
    return glm::mix(glm::mix(texel_at(*this, x0, y0), texel_at(*this, x1, y0), right_share),
                    glm::mix(texel_at(*this, x0, y1), texel_at(*this, x1, y1), right_share), bottom_share);
}

}  // namespace brisance
