// The header of an OpenEXR file, read without OpenEXR: whether what it claims can be in the file at all. OpenEXR
// believes the sizes of attributes, pictures and tiles, and allocates gigabytes for a file of a few hundred bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace brisance {

constexpr std::string_view kExrMagic("\x76\x2f\x31\x01", 4);

// Throws Error BadData when a header of `file` is damaged, reaches beyond its end, describes a picture of more than
// 2^28 pixels or 131072 pixels wide or high, or one that no compression could have made so small. Files that do not
// begin with kExrMagic, and deep ones, which hold no pictures, are left to their reader.
void check_exr_header(const std::filesystem::path& file);

}  // namespace brisance
