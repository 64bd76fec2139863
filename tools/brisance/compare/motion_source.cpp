#include "compare/motion_source.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace brisance {
namespace {

Plane channel_of(const Image& image, const Layer& layer, std::size_t channel) {
    Plane plane{image.width, image.height, {}};
    for (std::size_t i = channel; i < layer.pixels.size(); i += layer.channels.size())
        plane.values.push_back(layer.pixels[i]);
    return plane;
}

}  // namespace

MotionSource motion_source(const std::filesystem::path& file, const Image& image, const ExrMetadata& metadata,
                           const std::string& layer) {
    const auto find = [&](const std::string& name, std::size_t channels) {
        return std::find_if(image.layers.begin(), image.layers.end(),
                            [&](const Layer& l) { return l.name == name && l.channels.size() == channels; });
    };
    MotionSource source;
    if (!layer.empty()) {
        const auto vectors = find(layer, 2);
        if (vectors == image.layers.end())
            throw Error(ExitCode::BadData,
                        fmt::format("--motion: {} has no layer {} of two channels", file.string(), layer));
        source.vectors = motion_of_vectors(channel_of(image, *vectors, 0), channel_of(image, *vectors, 1));
    } else if (const auto depth = find("Z", 1); depth != image.layers.end() && metadata.ndc_from_world) {
        source.seen = SeenFrame{channel_of(image, *depth, 0), *metadata.ndc_from_world};
    }
    return source;
}

std::optional<Motion> motion_between(const MotionSource& before, const MotionSource& next) {
    if (next.vectors)
        return next.vectors;
    if (before.seen && next.seen)
        return camera_motion(*next.seen, *before.seen);
    return std::nullopt;
}

}  // namespace brisance
