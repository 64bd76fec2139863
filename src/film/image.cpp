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

}  // namespace brisance
