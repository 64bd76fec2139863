// PNGs in memory, for embedding in a page. Maps of at most 256 colours are stored indexed, at a third of the size. The
// writer of `film` does neither.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace brisance {

// Three numbers per pixel, rows from the top. Throws Error RenderFailed.
std::string encode_png(int width, int height, std::span<const std::uint8_t> rgb);

// One index into `palette` (three numbers per colour, at most 256 colours) per pixel.
std::string encode_indexed_png(int width, int height, std::span<const std::uint8_t> indices,
                               std::span<const std::uint8_t> palette);

// RFC 4648, with padding.
std::string base64(std::string_view bytes);

}  // namespace brisance
