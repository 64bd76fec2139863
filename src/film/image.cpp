#include "film/image.h"

#include <fmt/format.h>

#include "core/error.h"

namespace brisance {

const Layer& Image::layer(const std::string& name) const {
    std::string there;
    for (const Layer& layer : layers) {
        if (layer.name == name)
            return layer;
        there += fmt::format("{}{}", there.empty() ? "" : ", ", layer.name.empty() ? "beauty" : layer.name);
    }
    throw Error(ExitCode::BadData, fmt::format("the image has no layer \"{}\"; it has {}",
                                               name.empty() ? "beauty" : name, there.empty() ? "none" : there));
}

void add_to_mean(Image& mean, const Image& next, int count) {
    for (std::size_t l = 0; l < mean.layers.size(); ++l)
        for (std::size_t i = 0; i < mean.layers[l].pixels.size(); ++i) {
            float& pixel = mean.layers[l].pixels[i];
            pixel += (next.layers[l].pixels[i] - pixel) / float(count);
        }
}

}  // namespace brisance
