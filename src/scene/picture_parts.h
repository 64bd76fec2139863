// The parts of a PNG or a JPEG, found without their libraries: JPEG's takes memory for a whole progressive picture as
// soon as it is opened, and decoders of metadata read past the end of what is damaged.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace brisance {

struct PictureSize {
    std::int64_t width = 0, height = 0;
};

// How large the picture says it is. `bytes` begins like a PNG or a JPEG. Throws Error BadData, with `where`, when it
// has no size, and when a PNG's chunks do not end within it.
PictureSize claimed_size(std::string_view bytes, const std::string& where);

// The same picture without what pixels do not depend on: Exif, IPTC, XMP, colour profiles, comments. `bytes` has a
// claimed_size.
std::string without_metadata(std::string_view bytes);

}  // namespace brisance
