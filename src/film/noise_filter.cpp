#include "film/noise_filter.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kPatch = 1;                  // radius of patches [pixels]
constexpr float kStrength = 0.8f;          // k; least error of explosions of 4 paths per pixel (0.45 to 3 tried)
constexpr float kAlphaScale = 0.1f;        // s_alpha
constexpr float kDepthScale = 0.1f;        // s_z, relative
constexpr double kRelativeEpsilon = 1e-8;  // epsilon over the square of the picture's mean

bool is_filtered(const Layer& layer) {
    return layer.channels.size() >= 3 && layer.name != "albedo" && layer.name != "variance";
}

std::vector<float> colours_of(const Layer& layer) {
    const std::size_t channels = layer.channels.size(), pixels = layer.pixels.size() / channels;
    std::vector<float> out(3 * pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        std::copy_n(&layer.pixels[channels * p], 3, &out[3 * p]);
    return out;
}

// Means over 3^2 pixels, fewer at the border. The variance of a pixel is known from few paths only.
std::vector<float> smoothed(const std::vector<float>& values, int width, int height) {
    std::vector<float> out(values.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float sum[3] = {}, count = 0.0f;
            for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
                for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u, ++count)
                    for (int c = 0; c < 3; ++c)
                        sum[c] += values[3 * (std::size_t(v) * width + u) + c];
            for (int c = 0; c < 3; ++c)
                out[3 * (std::size_t(y) * width + x) + c] = sum[c] / count;
        }
    return out;
}

}  // namespace

NoiseFilter::NoiseFilter(const Image& picture, int radius)
    : width_(picture.width),
      height_(picture.height),
      radius_(radius),
      colour_(colours_of(picture.layer(""))),
      variance_(smoothed(picture.layer("variance").pixels, picture.width, picture.height)),
      depth_(picture.layer("Z").pixels),
      sum_(picture.layer("Z").pixels.size(), 0.0f) {
    const Layer& beauty = picture.layer("");
    double mean = 0.0;
    for (std::size_t p = 0; p < sum_.size(); ++p) {
        alpha_.push_back(beauty.pixels[4 * p + 3]);
        for (int c = 0; c < 3; ++c)
            mean += colour_[3 * p + c];
    }
    mean /= 3.0 * double(std::max<std::size_t>(sum_.size(), 1));
    epsilon_ = std::max(float(kRelativeEpsilon * mean * mean), 1e-35f);
    for_each_offset([&](std::size_t first, std::ptrdiff_t, const std::vector<float>& weight) {
        for (int x = 0; x < width_; ++x)
            sum_[first + x] += weight[x];
    });
}

// Of single pixels of a row, summed over channels, on top of what `out` holds.
void NoiseFilter::add_distances(const Offset& offset, int row, Row& out) const {
    const std::size_t first = std::size_t(row) * width_;
    const std::ptrdiff_t step = std::ptrdiff_t(offset.y) * width_ + offset.x;
    for (int x = std::max(0, -offset.x); x < std::min(width_, width_ - offset.x); ++x) {
        const std::size_t p = 3 * (first + x), q = 3 * (first + x + step);
        for (int c = 0; c < 3; ++c) {
            const float difference = colour_[p + c] - colour_[q + c], noise = variance_[p + c] + variance_[q + c];
            out.distance[x] += (difference * difference - noise) / (epsilon_ + kStrength * kStrength * noise);
        }
        out.pairs[x] += 3.0f;
    }
}

void NoiseFilter::find_weights(const Offset& offset, int row, Row& out) const {
    for (auto* values : {&out.distance, &out.pairs, &out.weight})
        values->assign(width_, 0.0f);
    for (int y = std::max(0, row - kPatch); y <= std::min(height_ - 1, row + kPatch); ++y)
        if (y + offset.y >= 0 && y + offset.y < height_)
            add_distances(offset, y, out);
    for (int x = std::max(0, -offset.x); x < std::min(width_, width_ - offset.x); ++x) {
        float distance = 0.0f, pairs = 0.0f;
        for (int k = std::max(0, x - kPatch); k <= std::min(width_ - 1, x + kPatch); ++k) {
            distance += out.distance[k];
            pairs += out.pairs[k];
        }
        const std::size_t p = std::size_t(row) * width_ + x,
                          q = std::size_t(std::ptrdiff_t(p) + std::ptrdiff_t(offset.y) * width_ + offset.x);
        const float alpha = (alpha_[p] - alpha_[q]) / kAlphaScale,
                    depth = (depth_[p] - depth_[q]) / (kDepthScale * std::min(depth_[p], depth_[q]));
        const float exponent = std::max(0.0f, distance / pairs) + alpha * alpha + depth * depth;
        out.weight[x] = std::exp(-exponent);
    }
}

template <class Take>
void NoiseFilter::for_each_offset(const Take& take) const {
    parallel_for(height_, [&](std::size_t row) {
        Row memory;
        const int y = int(row);
        for (int v = std::max(-radius_, -y); v <= std::min(radius_, height_ - 1 - y); ++v)
            for (int u = -radius_; u <= radius_; ++u) {
                find_weights({u, v}, y, memory);
                take(row * width_, std::ptrdiff_t(v) * width_ + u, memory.weight);
            }
    });
}

void NoiseFilter::apply(std::span<Image* const> pictures) const {
    struct Filtered {
        Layer* layer;
        std::vector<float> before;
    };
    std::vector<Filtered> layers, variances;
    for (Image* const picture : pictures)
        for (Layer& layer : picture->layers) {
            if (is_filtered(layer))
                layers.push_back({&layer, layer.pixels});
            if (layer.name == "variance")
                variances.push_back({&layer, layer.pixels});
        }
    // Of each pixel, what it keeps of itself.
    std::vector<float> kept(sum_.size(), 1.0f);
    for (Filtered& v : variances)
        std::fill(v.layer->pixels.begin(), v.layer->pixels.end(), 0.0f);
    for_each_offset([&](std::size_t first, std::ptrdiff_t step, const std::vector<float>& weight) {
        for (int x = 0; x < width_ && step != 0; ++x) {
            if (!(weight[x] > 0.0f))
                continue;
            const std::size_t p = first + x, q = std::size_t(std::ptrdiff_t(p) + step);
            const float share = weight[x] / std::max(sum_[p], sum_[q]);
            kept[p] -= share;
            for (Filtered& f : layers)
                for (std::size_t c = 0, n = f.layer->channels.size(); c < 3; ++c)
                    f.layer->pixels[n * p + c] += share * (f.before[n * q + c] - f.before[n * p + c]);
            for (Filtered& f : variances)
                for (std::size_t c = 0; c < 3; ++c)
                    f.layer->pixels[3 * p + c] += share * share * f.before[3 * q + c];
        }
    });
    for (Filtered& f : variances)
        for (std::size_t i = 0; i < f.before.size(); ++i)
            f.layer->pixels[i] += kept[i / 3] * kept[i / 3] * f.before[i];
}

}  // namespace brisance
