#include "camera_rays/moment_mean.h"

#include <algorithm>

namespace brisance {

namespace {

Layer* layer_named(Image& image, const std::string& name) {
    const auto found =
        std::find_if(image.layers.begin(), image.layers.end(), [&](const Layer& layer) { return layer.name == name; });
    return found == image.layers.end() ? nullptr : &*found;
}

}  // namespace

void MomentMean::add(Image picture) {
    Layer *const beauty = layer_named(picture, ""), *const z = layer_named(picture, "Z");
    if (beauty && z) {
        depth_.resize(z->pixels.size());
        opacity_.resize(z->pixels.size());
        for (std::size_t p = 0; p < z->pixels.size(); ++p) {
            const float alpha = beauty->pixels[4 * p + 3];
            if (alpha > 0.0f) {
                depth_[p] += alpha * z->pixels[p];
                opacity_[p] += alpha;
            }
        }
    }
    if (count_++ == 0) {
        sum_ = std::move(picture);
        return;
    }
    for (std::size_t l = 0; l < sum_.layers.size(); ++l)
        for (std::size_t i = 0; i < sum_.layers[l].pixels.size(); ++i)
            sum_.layers[l].pixels[i] += picture.layers[l].pixels[i];
}

Image MomentMean::take() {
    if (count_ == 1)
        return std::move(sum_);
    for (Layer& layer : sum_.layers)
        for (float& pixel : layer.pixels)
            pixel /= float(count_);
    if (Layer* const z = layer_named(sum_, "Z"))
        for (std::size_t p = 0; p < depth_.size(); ++p)
            if (opacity_[p] > 0.0f)
                z->pixels[p] = depth_[p] / opacity_[p];
    return std::move(sum_);
}

}  // namespace brisance
