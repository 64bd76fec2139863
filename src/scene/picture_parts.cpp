#include "scene/picture_parts.h"

#include <algorithm>

#include "core/error.h"

namespace brisance {
namespace {

[[noreturn]] void throw_no_size(const std::string& where) {
    throw Error(ExitCode::BadData,
                where + ": damaged: it does not say how large it is; export or copy the picture again");
}

std::uint32_t big_endian(std::string_view bytes) {
    std::uint32_t value = 0;
    for (const char byte : bytes)
        value = (value << 8) | static_cast<unsigned char>(byte);
    return value;
}

constexpr std::size_t kPngSignature = 8;

// A length, a type, as many bytes and a checksum.
struct PngChunk {
    std::string_view type;
    std::size_t size = 0;  // of the whole chunk; 0: it does not end within the bytes
};

PngChunk png_chunk(std::string_view bytes, std::size_t at) {
    constexpr std::size_t around = 12;
    const std::size_t rest = bytes.size() - at;
    if (rest < around || big_endian(bytes.substr(at, 4)) > rest - around)
        return {};
    return {bytes.substr(at + 4, 4), around + big_endian(bytes.substr(at, 4))};
}

// Chunks from IHDR to IEND. OpenImageIO loses memory with each PNG that ends before its last chunk.
PictureSize size_of_png(std::string_view bytes, const std::string& where) {
    constexpr std::size_t width = 16, height = 20, least = 24;
    if (bytes.size() < least || bytes.substr(kPngSignature + 4, 4) != "IHDR")
        throw_no_size(where);
    std::size_t at = kPngSignature;
    for (PngChunk chunk; chunk.type != "IEND"; at += chunk.size) {
        chunk = png_chunk(bytes, at);
        if (chunk.size == 0)
            throw Error(ExitCode::BadData, where + ": the png is truncated; export or copy the picture again");
    }
    return {big_endian(bytes.substr(width, 4)), big_endian(bytes.substr(height, 4))};
}

// Of what need not be understood (names that begin with a small letter) transparency alone reaches the pixels.
bool reaches_pixels(const PngChunk& chunk) {
    const bool critical = (chunk.type[0] & 0x20) == 0;
    return critical || chunk.type == "tRNS";
}

std::string png_without_metadata(std::string_view bytes) {
    std::string kept(bytes.substr(0, kPngSignature));
    std::size_t at = kPngSignature;
    for (PngChunk chunk; chunk.type != "IEND"; at += chunk.size) {
        chunk = png_chunk(bytes, at);
        if (reaches_pixels(chunk))
            kept += bytes.substr(at, chunk.size);
    }
    return kept;
}

// A marker with a length and as many bytes, a marker alone, or what is between two markers: compressed pixels, or bytes
// that JPEG's library skips.
struct JpegPart {
    unsigned marker = 0;  // 0: no marker
    std::size_t size = 0;
};

JpegPart jpeg_part(std::string_view bytes, std::size_t at) {
    constexpr unsigned char alone_first = 0xd0, alone_last = 0xd8, temporary = 0x01;  // markers without a length
    const std::size_t rest = bytes.size() - at;
    const auto second = rest > 1 ? static_cast<unsigned char>(bytes[at + 1]) : std::uint8_t{0};
    if (bytes[at] != '\xff' || second == 0 || second == 0xff)
        return {0, std::min(bytes.find('\xff', at + 1), bytes.size()) - at};
    if (second == temporary || (second >= alone_first && second <= alone_last))
        return {second, 2};
    const std::size_t length = std::max(big_endian(bytes.substr(at + 2, 2)), 2u);
    return {second, std::min(2 + length, rest)};
}

bool begins_frame(unsigned marker) {
    constexpr unsigned first = 0xc0, last = 0xcf, huffman = 0xc4, extension = 0xc8, arithmetic = 0xcc;
    return marker >= first && marker <= last && marker != huffman && marker != extension && marker != arithmetic;
}

PictureSize size_of_jpeg(std::string_view bytes, const std::string& where) {
    constexpr std::size_t start = 2, height = 5, width = 7, end = 9;
    for (std::size_t at = start; at + end <= bytes.size();) {
        const JpegPart part = jpeg_part(bytes, at);
        if (begins_frame(part.marker))
            return {big_endian(bytes.substr(at + width, 2)), big_endian(bytes.substr(at + height, 2))};
        at += part.size;
    }
    throw_no_size(where);
}

// Of what applications add, JFIF and Adobe's segment say which colours are stored.
bool reaches_pixels(const JpegPart& part) {
    constexpr unsigned first = 0xe0, jfif = 0xe0, adobe = 0xee, last = 0xef, comment = 0xfe;
    const bool of_application = part.marker >= first && part.marker <= last;
    return part.marker == jfif || part.marker == adobe || (!of_application && part.marker != comment);
}

std::string jpeg_without_metadata(std::string_view bytes) {
    std::string kept;
    for (std::size_t at = 0; at < bytes.size();) {
        const JpegPart part = jpeg_part(bytes, at);
        if (reaches_pixels(part))
            kept += bytes.substr(at, part.size);
        at += part.size;
    }
    return kept;
}

}  // namespace

PictureSize claimed_size(std::string_view bytes, const std::string& where) {
    return bytes.starts_with('\xff') ? size_of_jpeg(bytes, where) : size_of_png(bytes, where);
}

std::string without_metadata(std::string_view bytes) {
    return bytes.starts_with('\xff') ? jpeg_without_metadata(bytes) : png_without_metadata(bytes);
}

}  // namespace brisance
