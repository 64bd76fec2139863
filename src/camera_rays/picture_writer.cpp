#include "camera_rays/picture_writer.h"

#include <algorithm>

namespace brisance {

PictureWriter::PictureWriter(const Camera& camera, const PictureSettings& settings) : camera_(camera) {
    image_.width = camera.settings().width;
    image_.height = camera.settings().height;
    const std::size_t pixels = std::size_t(image_.width) * image_.height;
    const auto add = [&](const char* name, std::vector<std::string> channels, bool full) {
        Layer layer{name, std::move(channels), full, {}};
        layer.pixels.assign(pixels * layer.channels.size(), 0.0f);
        image_.layers.push_back(std::move(layer));
        return static_cast<int>(image_.layers.size()) - 1;
    };
    beauty_ = add("", {"R", "G", "B", "A"}, false);
    cells_.fill(-1);
    for (int cell = 0; cell < kCells; ++cell)
        if (settings.cells && settings.layers[cell])
            cells_[cell] = add(kCellNames[cell], {"R", "G", "B"}, false);
    z_ = add("Z", {"Z"}, true);
    albedo_ = add("albedo", {"R", "G", "B"}, false);
    if (settings.once) {
        from_fire_.resize(pixels, Rgb(0.0f));
        from_emitters_.resize(pixels, Rgb(0.0f));
    }
}

void PictureWriter::pixel(int x, int y, const RaySum& seen) {
    add(x, y, seen);
    // Distances are along the ray; Z is along the view axis.
    const double cosine = glm::dot(camera_.ray(x + 0.5, y + 0.5).direction, camera_.forward());
    image_.layers[z_].pixels[std::size_t(y) * image_.width + x] =
        seen.distance_weight > 0.0f ? static_cast<float>(seen.distance_sum / seen.distance_weight * cosine) : 1e10f;
}

void PictureWriter::add(int x, int y, const RaySum& more) {
    const std::size_t i = std::size_t(y) * image_.width + x;
    Rgb beauty(0.0f);
    for (const Rgb& cell : more.cells)
        beauty += cell;
    float* b = &image_.layers[beauty_].pixels[4 * i];
    b[0] += beauty.x, b[1] += beauty.y, b[2] += beauty.z, b[3] += more.alpha;
    for (int cell = 0; cell < kCells; ++cell)
        put(cells_[cell], i, more.cells[cell]);
    put(albedo_, i, more.albedo_sum);
    if (!from_fire_.empty()) {
        from_fire_[i] += more.once_from_fire;
        from_emitters_[i] += more.once_from_emitters;
    }
}

void PictureWriter::replace(int x, int y, const RaySum& seen) {
    clear(x, y);
    add(x, y, seen);
}

void PictureWriter::clear(int x, int y) {
    const std::size_t i = std::size_t(y) * image_.width + x;
    for (int l = 0; l < static_cast<int>(image_.layers.size()); ++l)
        if (Layer& layer = image_.layers[l]; l != z_) {
            const std::size_t n = layer.channels.size();
            std::fill_n(layer.pixels.begin() + std::ptrdiff_t(i * n), n, 0.0f);
        }
    if (!from_fire_.empty())
        from_fire_[i] = from_emitters_[i] = Rgb(0.0f);
}

float PictureWriter::luminance_at(int x, int y) const {
    const float* b = &image_.layers[beauty_].pixels[4 * (std::size_t(y) * image_.width + x)];
    return luminance(Rgb(b[0], b[1], b[2]));
}

Image PictureWriter::take() {
    if (!from_fire_.empty()) {
        file_single_scattering(Cell::MV, from_fire_);
        file_single_scattering(Cell::MA, from_emitters_);
    }
    return std::move(image_);
}

// Keeps single scattering in the cell and moves the rest to MM, so that every path is in its own layer.
void PictureWriter::file_single_scattering(Cell cell, const std::vector<Rgb>& once) {
    const int layer = cells_[static_cast<int>(cell)], multiple = cells_[static_cast<int>(Cell::MM)];
    if (layer < 0 || multiple < 0)
        return;
    std::vector<float>& single = image_.layers[layer].pixels;
    std::vector<float>& rest = image_.layers[multiple].pixels;
    for (std::size_t i = 0; i < single.size(); ++i) {
        const float both = single[i] + rest[i];
        single[i] = std::clamp(once[i / 3][static_cast<int>(i % 3)], 0.0f, std::max(both, 0.0f));
        rest[i] = both - single[i];
    }
}

void PictureWriter::put(int layer, std::size_t pixel, const Rgb& c) {
    if (layer < 0)
        return;
    float* p = &image_.layers[layer].pixels[3 * pixel];
    p[0] += c.x, p[1] += c.y, p[2] += c.z;
}

}  // namespace brisance
