#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/printable.h"
#include "film/view_transform.h"
#include "film/whole_file.h"
#include "film/write_image.h"
#include "image_formats/image_formats.h"

namespace brisance {
namespace {

std::vector<std::uint8_t> display_pixels(const Image& image, const Layer& beauty, float exposure_stops,
                                         ViewTransform view) {
    const std::size_t channels = beauty.channels.size();
    const auto width = static_cast<std::size_t>(image.width);
    const float scale = std::exp2(exposure_stops);
    std::vector<std::uint8_t> bytes(width * static_cast<std::size_t>(image.height) * 3);
    parallel_for(static_cast<std::size_t>(image.height), [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            const float* const p = &beauty.pixels[(y * width + x) * channels];
            const vec3 shown = apply_view(scale * Rgb(p[0], p[1], p[2]), view);
            for (int c = 0; c < 3; ++c)
                bytes[(y * width + x) * 3 + static_cast<std::size_t>(c)] =
                    static_cast<std::uint8_t>(std::lround(255.0f * shown[c]));
        }
    });
    return bytes;
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image& image, float exposure_stops, ViewTransform view) {
    const Layer& beauty = image.layer("");
    const auto pixel_count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (beauty.channels.size() < 3 || beauty.pixels.size() != pixel_count * beauty.channels.size())
        throw Error(ExitCode::RenderFailed,
                    fmt::format("cannot write {}: the beauty is no RGB picture", file.string()));
    write_png(file, image.width, image.height, display_pixels(image, beauty, exposure_stops, view));
}

void write_png(const std::filesystem::path& file, int width, int height, const std::vector<std::uint8_t>& rgb) {
    if (width < 1 || height < 1 || rgb.size() != 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
        throw Error(ExitCode::RenderFailed, fmt::format("cannot write {}: the pixels do not fill it", file.string()));
    std::string why;
    const std::vector<unsigned char> encoded = image_formats().encode_png(width, height, rgb, why);
    if (encoded.empty())
        throw Error(ExitCode::RenderFailed, fmt::format("cannot encode {}: {}", file.string(), printable(why)));
    write_whole_file(file, {reinterpret_cast<const char*>(encoded.data()), encoded.size()});
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    write_whole_file(file, text);
}

}  // namespace brisance
