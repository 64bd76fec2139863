#include "page_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "core/parallel.h"
#include "film/view_transform.h"
#include "film/write_image.h"
#include "metrics/false_colour.h"
#include "png.h"

namespace brisance {
namespace {

constexpr int kLevels = 256;       // of a map
constexpr double kDecades = 3.0;   // of relative error in its map, up to 1
constexpr int kPaletteStops = 17;  // of the colour bar

// Weighted sources of each of `count` targets along one axis of `size`.
struct Share {
    int source = 0;
    float weight = 0.0f;
};

std::vector<std::vector<Share>> shares(int size, int count) {
    std::vector<std::vector<Share>> all(static_cast<std::size_t>(count));
    const double step = static_cast<double>(size) / count;
    for (int i = 0; i < count; ++i) {
        const double begin = i * step, end = begin + step;
        for (int s = static_cast<int>(begin); s < size && s < end; ++s) {
            const double covered = std::min<double>(end, s + 1) - std::max<double>(begin, s);
            if (covered > 0.0)
                all[static_cast<std::size_t>(i)].push_back({s, static_cast<float>(covered / step)});
        }
    }
    return all;
}

template <class T>
std::vector<T> reduced_values(const std::vector<T>& values, int width, int height, int new_width, int new_height) {
    const auto columns = shares(width, new_width), rows = shares(height, new_height);
    std::vector<T> result(static_cast<std::size_t>(new_width) * static_cast<std::size_t>(new_height), T(0.0f));
    std::size_t out = 0;
    for (const std::vector<Share>& row : rows)
        for (const std::vector<Share>& column : columns) {
            for (const Share& y : row)
                for (const Share& x : column)
                    result[out] += y.weight * x.weight *
                                   values[static_cast<std::size_t>(y.source) * static_cast<std::size_t>(width) +
                                          static_cast<std::size_t>(x.source)];
            ++out;
        }
    return result;
}

int reduced_height(int width, int height, int most_width) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(height) * most_width / width)));
}

std::string exposed_png(const Picture& picture, double stops, ViewTransform view) {
    const auto scale = static_cast<float>(std::exp2(stops));
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * picture.pixels.size());
    for (const Rgb& pixel : picture.pixels) {
        const vec3 shown = apply_view(scale * pixel, view);
        for (int c = 0; c < 3; ++c)
            bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0f * shown[c])));
    }
    return base64(encode_png(picture.width, picture.height, bytes));
}

// Colours of `count` errors from 0 to 1.
std::vector<std::uint8_t> ramp(int count) {
    Plane errors{count, 1, {}};
    for (int i = 0; i < count; ++i)
        errors.values.push_back(static_cast<float>(i) / static_cast<float>(count - 1));
    return false_colours(errors);
}

std::string map_png(const Plane& errors) {
    static const std::vector<std::uint8_t> palette = ramp(kLevels);
    std::vector<std::uint8_t> indices;
    indices.reserve(errors.values.size());
    for (const float error : errors.values)
        indices.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(error, 0.0f, 1.0f) * (kLevels - 1))));
    return base64(encode_indexed_png(errors.width, errors.height, indices, palette));
}

nlohmann::ordered_json palette_json() {
    const std::vector<std::uint8_t> colours = ramp(kPaletteStops);
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < colours.size(); i += 3)
        json.push_back(fmt::format("#{:02x}{:02x}{:02x}", colours[i], colours[i + 1], colours[i + 2]));
    return json;
}

}  // namespace

Plane relative_error_map(const Picture& image, const Picture& reference, double epsilon) {
    Plane map{image.width, image.height, std::vector<float>(image.pixels.size())};
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        double error = 0.0;
        for (int c = 0; c < 3; ++c) {
            const double r = reference.pixels[i][c];
            error += std::abs(image.pixels[i][c] - r) / (std::abs(r) + epsilon) / 3.0;
        }
        // Black against black where the whole reference is black: 0 / 0, and no error.
        if (image.pixels[i] == reference.pixels[i])
            error = 0.0;
        map.values[i] =
            std::isfinite(error) ? static_cast<float>(std::clamp(std::log10(error) / kDecades + 1.0, 0.0, 1.0)) : 1.0f;
    }
    return map;
}

double exposure_for(const Picture& picture) {
    Image image{picture.width, picture.height, {{"", {"R", "G", "B"}, false, {}}}};
    for (const Rgb& pixel : picture.pixels)
        image.layers[0].pixels.insert(image.layers[0].pixels.end(), {pixel.x, pixel.y, pixel.z});
    return automatic_exposure(image);
}

Picture reduced(const Picture& picture, int most_width) {
    if (picture.width <= most_width)
        return picture;
    const int height = reduced_height(picture.width, picture.height, most_width);
    return {most_width, height, reduced_values(picture.pixels, picture.width, picture.height, most_width, height)};
}

Plane reduced(const Plane& plane, int most_width) {
    if (plane.width <= most_width)
        return plane;
    const int height = reduced_height(plane.width, plane.height, most_width);
    return {most_width, height, reduced_values(plane.values, plane.width, plane.height, most_width, height)};
}

void PagePictures::add_picture(const std::string& id, const std::string& layer, const Picture& picture) {
    const Picture shown = reduced(picture, settings_.most_width);
    width_ = shown.width;
    height_ = shown.height;
    std::vector<std::string> encoded(settings_.exposures.size());
    parallel_for(encoded.size(), [&](std::size_t i) {
        encoded[i] = exposed_png(shown, settings_.base_exposure + settings_.exposures[i], settings_.view);
    });
    images_[id][layer] = encoded;
}

void PagePictures::add_errors(const std::string& id, const std::string& layer, const Picture& image,
                              const Picture& reference, double epsilon, const Plane& flip) {
    relative_[id][layer] = map_png(reduced(relative_error_map(image, reference, epsilon), settings_.most_width));
    flip_[id][layer] = map_png(reduced(flip, settings_.most_width));
}

void PagePictures::add_strip(const std::string& id, const std::string& cell, std::span<const Picture> frames,
                             const Plane& change, double exposure) {
    std::vector<std::string> encoded;
    for (const Picture& frame : frames)
        encoded.push_back(exposed_png(reduced(frame, settings_.strip_width), exposure, settings_.view));
    strips_[id][cell] = {
        {"frames", encoded}, {"change", map_png(reduced(change, settings_.strip_width))}, {"exposure", exposure}};
}

nlohmann::ordered_json PagePictures::to_json() const {
    return {{"width", width_},
            {"height", height_},
            {"base_exposure", settings_.base_exposure},
            {"exposures", settings_.exposures},
            {"view", settings_.view == ViewTransform::Filmic ? "filmic" : "sRGB"},
            {"palette", palette_json()},
            {"images", images_},
            {"relative", relative_},
            {"flip", flip_},
            {"strips", strips_}};
}

}  // namespace brisance
