#include "scene/picture_size.h"

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

// Chunks of a length, a type, as many bytes and a checksum, from IHDR to IEND. OpenImageIO loses memory with each PNG
// that ends before its last chunk.
PictureSize size_of_png(std::string_view bytes, const std::string& where) {
    constexpr std::size_t signature = 8, type = 4, content = 8, around = 12, width = 16, height = 20, least = 24;
    if (bytes.size() < least || bytes.substr(signature + type, 4) != "IHDR")
        throw_no_size(where);
    std::size_t at = signature;
    for (std::string_view name; name != "IEND";) {
        const std::size_t rest = bytes.size() - at;
        if (rest < around || big_endian(bytes.substr(at, 4)) > rest - around)
            throw Error(ExitCode::BadData, where + ": the png is truncated; export or copy the picture again");
        name = bytes.substr(at + type, content - type);
        at += around + big_endian(bytes.substr(at, 4));
    }
    return {big_endian(bytes.substr(width, 4)), big_endian(bytes.substr(height, 4))};
}

bool begins_frame(unsigned marker) {
    constexpr unsigned first = 0xc0, last = 0xcf, huffman = 0xc4, extension = 0xc8, arithmetic = 0xcc;
    return marker >= first && marker <= last && marker != huffman && marker != extension && marker != arithmetic;
}

// Segments of a marker, a length and as many bytes. JPEG's library skips what is between them.
PictureSize size_of_jpeg(std::string_view bytes, const std::string& where) {
    constexpr std::size_t start = 2, height = 5, width = 7, end = 9;
    for (std::size_t at = start; at + 4 <= bytes.size();) {
        const auto marker = static_cast<unsigned char>(bytes[at + 1]);
        const bool is_marker = bytes[at] == '\xff' && marker != 0 && marker != 0xff;
        constexpr unsigned char alone_first = 0xd0, alone_last = 0xd8, temporary = 0x01;  // markers without a length
        if (!is_marker) {
            ++at;
        } else if (begins_frame(marker)) {
            if (at + end > bytes.size())
                break;
            return {big_endian(bytes.substr(at + width, 2)), big_endian(bytes.substr(at + height, 2))};
        } else if (marker == temporary || (marker >= alone_first && marker <= alone_last)) {
            at += 2;
        } else {
            at += 2 + std::size_t{big_endian(bytes.substr(at + 2, 2))};
        }
    }
    throw_no_size(where);
}

}  // namespace

PictureSize claimed_size(std::string_view bytes, const std::string& where) {
    return bytes.starts_with('\xff') ? size_of_jpeg(bytes, where) : size_of_png(bytes, where);
}

}  // namespace brisance
