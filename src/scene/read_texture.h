// Pictures of files and of memory as textures.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scene/texture.h"

namespace brisance {

// PNG, JPEG, Radiance, OpenEXR and TIFF; the first picture where a file has several. Up to 8 bits a channel stay bytes;
// all else becomes floats, which are made linear here and now where `srgb` says so. Values that are not finite become
// 0. Alpha is not multiplied into colours. Throws Error MissingInput, BadData, or Temporary where the pixels alone
// would take more than `memory_limit` bytes.
Texture read_texture(const std::filesystem::path& file, bool srgb, std::uint64_t memory_limit);

// A PNG or JPEG in memory. `where` begins the lines of errors.
Texture read_texture(std::span<const unsigned char> bytes, const std::string& where, bool srgb,
                     std::uint64_t memory_limit);

}  // namespace brisance
