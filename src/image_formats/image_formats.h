// Pictures in the formats that OpenImageIO knows. The library and the 250 that it needs take 0.2 s to load. They stand
// behind a plugin that is loaded with the first picture: a run that reads and writes none but EXR never pays for them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace brisance {

struct StoredImage {
    int width = 0, height = 0, depth = 0, channels = 0;
    bool eight_bits = false;  // at most 8 bits a channel
};

// A picture whose header has been read. Values are as the file stores them, alpha not multiplied into colours.
class ImageReader {
public:
    virtual ~ImageReader() = default;
    virtual StoredImage stored() const = 0;
    // The first `channels` channels of every pixel, rows from the top. False where the file is damaged, see error().
    virtual bool read(int channels, std::span<std::uint8_t> pixels) = 0;
    virtual bool read(int channels, std::span<float> pixels) = 0;
    virtual std::string error() = 0;
};

// What the plugin offers. Failures are null or empty, and say why in `why`: the library's own words, not sanitised.
class ImageFormats {
public:
    virtual ~ImageFormats() = default;
    // `format`: OpenImageIO's name, such as "png". `bytes` must live as long as the reader.
    virtual std::unique_ptr<ImageReader> open_file(const std::string& file, const char* format,
                                                   std::string& why) const = 0;
    virtual std::unique_ptr<ImageReader> open_bytes(std::string_view bytes, const char* format,
                                                    std::string& why) const = 0;
    // sRGB, three channels of 8 bits.
    virtual std::vector<unsigned char> encode_png(int width, int height, std::span<const std::uint8_t> rgb,
                                                  std::string& why) const = 0;
};

// Loads the plugin at the first call. Safe from several threads. Throws Error RenderFailed where it cannot be loaded.
const ImageFormats& image_formats();

}  // namespace brisance
