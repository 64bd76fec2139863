// An image on a surface or around the scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"

namespace brisance {

enum class Wrap { Repeat, Mirror, Clamp };

// Eight bits a channel as files have them, or floats. Row 0 is the top, where glTF's v is 0.
class Texture {
public:
    std::string name;  // of the file, for messages
    int width = 0, height = 0;
    Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;
    bool nearest = false;             // else bilinear
    bool srgb = false;                // rgb are stored by sRGB's curve, alpha is linear in any case
    std::vector<std::uint8_t> bytes;  // RGBA
    std::vector<float> floats;        // RGBA, instead of bytes

    // Linear RGBA at uv, interpolated in linear light. Coordinates that are not finite count as 0.
    vec4 at(vec2 uv) const;
};

}  // namespace brisance
