#include "metrics/layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace brisance {
namespace {

const char* const kGray = "Y";

std::size_t channel_index(const Layer& layer, const std::string& channel) {
    const auto found = std::find(layer.channels.begin(), layer.channels.end(), channel);
    return static_cast<std::size_t>(found - layer.channels.begin());
}

bool has(const Layer& layer, const std::string& channel) {
    return channel_index(layer, channel) < layer.channels.size();
}

bool is_colour(const Layer& layer) {
    return has(layer, "R") && has(layer, "G") && has(layer, "B");
}

bool is_gray(const Layer& layer) {
    return !is_colour(layer) && has(layer, kGray);
}

// A bare Y channel is the beauty of a gray file.
std::string name_of(const Layer& layer) {
    return layer.name == kGray ? "" : layer.name;
}

const Layer& find(const Image& image, const std::string& name) {
    for (const Layer& layer : image.layers)
        if ((is_colour(layer) || is_gray(layer)) && name_of(layer) == name)
            return layer;
    throw Error(ExitCode::BadData,
                fmt::format("the image has no layer {} of colour or gray", name.empty() ? "beauty" : name));
}

void add(const Layer& layer, Picture& picture) {
    const std::size_t n = layer.channels.size();
    const bool gray = is_gray(layer);
    const std::size_t r = channel_index(layer, gray ? kGray : "R");
    const std::size_t g = channel_index(layer, gray ? kGray : "G");
    const std::size_t b = channel_index(layer, gray ? kGray : "B");
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] += Rgb(layer.pixels[n * i + r], layer.pixels[n * i + g], layer.pixels[n * i + b]);
}

}  // namespace

std::vector<std::string> picture_layers(const Image& image) {
    std::vector<std::string> names;
    for (const Layer& layer : image.layers)
        if (is_colour(layer) || is_gray(layer))
            names.insert(name_of(layer).empty() ? names.begin() : names.end(), name_of(layer));
    return names;
}

LayerPicture picture_of(const Image& image, const std::vector<std::string>& layers) {
    const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    LayerPicture result{{image.width, image.height, std::vector<Rgb>(count, Rgb(0.0f))}};
    for (const std::string& name : layers) {
        const Layer& layer = find(image, name);
        result.gray = result.gray || is_gray(layer);
        add(layer, result.picture);
    }
    if (result.gray)
        to_gray(result.picture);
    return result;
}

void to_gray(Picture& picture) {
    for (Rgb& pixel : picture.pixels)
        // Equal channels keep their bits: the weights add up to 1 only up to rounding.
        if (pixel.x != pixel.y || pixel.y != pixel.z)
            pixel = Rgb(luminance(pixel));
}

}  // namespace brisance
