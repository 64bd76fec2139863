// How large a PNG or a JPEG says it is, read without their libraries: JPEG's takes memory for a whole progressive
// picture as soon as it is opened.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace brisance {

struct PictureSize {
    std::int64_t width = 0, height = 0;
};

// `bytes` begins like a PNG or a JPEG. Throws Error BadData, with `where`, when it has no size, and when a
// PNG's chunks do not end within it.
PictureSize claimed_size(std::string_view bytes, const std::string& where);

}  // namespace brisance
