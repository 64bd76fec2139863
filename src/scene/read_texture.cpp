#include "scene/read_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>

#include "core/error.h"
#include "core/exr_header.h"
#include "core/input_file.h"
#include "core/printable.h"
#include "image_formats/image_formats.h"
#include "scene/picture_parts.h"
#include "scene/srgb.h"

namespace brisance {
namespace {

[[noreturn]] void reject(const std::string& where, const std::string& why) {
    throw Error(ExitCode::BadData, fmt::format("{}: {}; export or copy the picture again", where, why));
}

// One, two, three or four channels as RGBA: grey is R = G = B, what has no alpha is opaque.
template <class T>
std::vector<T> as_rgba(const std::vector<T>& pixels, int channels, T opaque) {
    const auto n = static_cast<std::size_t>(channels);
    const bool grey = channels < 3, alpha = channels == 2 || channels == 4;
    std::vector<T> rgba(pixels.size() / n * 4);
    for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
        const T* const from = &pixels[i * n];
        for (std::size_t c = 0; c < 3; ++c)
            rgba[4 * i + c] = from[grey ? 0 : c];
        rgba[4 * i + 3] = alpha ? from[n - 1] : opaque;
    }
    return rgba;
}

template <class T>
std::vector<T> read_rgba(ImageReader& input, const std::string& where, T opaque) {
    const StoredImage stored = input.stored();
    const int channels = std::min(stored.channels, 4);
    std::vector<T> pixels(static_cast<std::size_t>(stored.width) * static_cast<std::size_t>(stored.height) *
                          static_cast<std::size_t>(channels));
    if (!input.read(channels, pixels))
        reject(where, "truncated or damaged: " + printable(input.error()));
    return channels == 4 ? pixels : as_rgba(pixels, channels, opaque);
}

// Sums over a picture that holds more overflow: only a damaged one does.
constexpr float kBrightest = 1e20f;

void check_brightest(const std::vector<float>& rgba, const std::string& where) {
    const auto too_bright = [](float value) { return std::abs(value) > kBrightest && std::isfinite(value); };
    const auto found = std::find_if(rgba.begin(), rgba.end(), too_bright);
    if (found != rgba.end())
        reject(where, fmt::format("damaged: it holds the value {:g}, at most {:g} can be used", *found, kBrightest));
}

void make_linear(std::vector<float>& rgba, bool srgb) {
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        rgba[i] = std::isfinite(rgba[i]) ? rgba[i] : 0.0f;
        if (srgb && i % 4 != 3)
            rgba[i] = linear_from_srgb(rgba[i]);
    }
}

// OpenImageIO reads up to 256 lines at once, whatever is left of the memory.
constexpr std::int64_t kLongestSide = 1 << 16;

void check_size(std::int64_t width, std::int64_t height, double channel_bytes, const std::string& where,
                std::uint64_t memory_limit) {
    if (width < 1 || height < 1 || width > kLongestSide || height > kLongestSide)
        reject(where, fmt::format("its size of {} x {} makes no sense", width, height));
    const double size = 4.0 * static_cast<double>(width * height) * channel_bytes;
    if (size > static_cast<double>(memory_limit))
        throw Error(ExitCode::Temporary, fmt::format("{}: {} x {} pixels need {:.2f} GiB, more than is left; use a "
                                                     "smaller picture, or a machine with more memory",
                                                     where, width, height, size / 0x1p30));
}

Texture read_opened(ImageReader& input, const std::string& where, bool srgb, std::uint64_t memory_limit) {
    const StoredImage stored = input.stored();
    const bool bytes = stored.eight_bits;
    if (stored.depth > 1 || stored.channels < 1)
        reject(where, "it is no flat picture");
    check_size(stored.width, stored.height, bytes ? 1.0 : 4.0, where, memory_limit);
    Texture texture;
    texture.width = stored.width;
    texture.height = stored.height;
    texture.srgb = srgb && bytes;
    if (bytes) {
        texture.bytes = read_rgba<std::uint8_t>(input, where, 255);
    } else {
        texture.floats = read_rgba<float>(input, where, 1.0f);
        check_brightest(texture.floats, where);
        make_linear(texture.floats, srgb);
    }
    return texture;
}

// The two formats of glTF: how they begin, and what stands at their end. Their libraries fill up with grey what is
// missing of a JPEG, and print lines of their own about a PNG: a picture that is cut off is found before they see it.
struct Format {
    const char* name;  // of image_formats.h
    std::string_view begin, end;
};
constexpr Format kFormats[] = {{"png", "\x89PNG", "IEND"}, {"jpeg", "\xff\xd8\xff", "\xff\xd9"}};

const Format* format_of(std::string_view bytes) {
    const auto* const found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                           [&](const Format& format) { return bytes.starts_with(format.begin); });
    return found != std::end(kFormats) ? found : nullptr;
}

Texture read_memory(std::string_view bytes, const std::string& where, bool srgb, std::uint64_t memory_limit) {
    const Format* const format = format_of(bytes);
    if (format == nullptr)
        reject(where, "neither a PNG nor a JPEG");
    // In the second half: a preview within a JPEG ends too, but it comes first.
    if (bytes.substr(bytes.size() / 2).find(format->end) == std::string_view::npos)
        reject(where, fmt::format("the {} is truncated", format->name));
    const PictureSize size = claimed_size(bytes, where);
    check_size(size.width, size.height, 1.0, where, memory_limit);
    const std::string picture = without_metadata(bytes);
    std::string why;
    const auto input = image_formats().open_bytes(picture, format->name, why);
    if (!input)
        reject(where, "damaged: " + printable(why));
    return read_opened(*input, where, srgb, memory_limit);
}

// What else is read, by how it begins. OpenImageIO alone would try all the libraries that it was built with, some of
// which were never meant for files from outside.
constexpr Format kOtherFormats[] = {
    {"hdr", "#?", {}},          {"openexr", kExrMagic, {}}, {"tiff", {"II*\0", 4}, {}},
    {"tiff", {"MM\0*", 4}, {}}, {"tiff", {"II+\0", 4}, {}}, {"tiff", {"MM\0+", 4}, {}},
};

Texture read_file(const std::filesystem::path& file, std::string_view begin, bool srgb, std::uint64_t memory_limit) {
    const std::string where = file.string();
    const auto* const format = std::find_if(std::begin(kOtherFormats), std::end(kOtherFormats),
                                            [&](const Format& f) { return begin.starts_with(f.begin); });
    if (format == std::end(kOtherFormats))
        reject(where, "not a picture that can be read: PNG, JPEG, Radiance, OpenEXR or TIFF");
    check_exr_header(file);
    std::string why;
    const auto input = image_formats().open_file(where, format->name, why);
    if (!input)
        reject(where, "not a picture that can be read: " + printable(why));
    return read_opened(*input, where, srgb, memory_limit);
}

// All bytes of a PNG or JPEG, and the first ones of anything else.
std::string bytes_of_format(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string bytes(4, '\0');
    in.read(bytes.data(), 4);
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    if (!in || format_of(bytes) == nullptr)
        return bytes;
    return bytes + std::string(std::istreambuf_iterator<char>(in), {});
}

}  // namespace

Texture read_texture(const std::filesystem::path& file, bool srgb, std::uint64_t memory_limit) {
    size_of_input(file);
    const std::string bytes = bytes_of_format(file);
    Texture texture = format_of(bytes) == nullptr ? read_file(file, bytes, srgb, memory_limit)
                                                  : read_memory(bytes, file.string(), srgb, memory_limit);
    texture.name = file.filename().string();
    return texture;
}

Texture read_texture(std::span<const unsigned char> bytes, const std::string& where, bool srgb,
                     std::uint64_t memory_limit) {
    return read_memory({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, where, srgb, memory_limit);
}

}  // namespace brisance
