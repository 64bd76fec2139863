// Finished pixels to layers.
#pragma once

#include <array>
#include <vector>

#include "camera_rays/picture.h"
#include "film/image.h"

namespace brisance {

class PictureWriter {
public:
    // Keeps a reference to the camera. `settings` determine the layers.
    PictureWriter(const Camera& camera, const PictureSettings& settings);

    void pixel(int x, int y, const RaySum& seen);
    // Adds further data of a pixel to all layers but Z.
    void add(int x, int y, const RaySum& more);
    // The same in the place of what was added.
    void replace(int x, int y, const RaySum& seen);
    float luminance_at(int x, int y) const;  // of the picture

    Image take();

private:
    void put(int layer, std::size_t pixel, const Rgb& c);
    void clear(int x, int y);
    void file_single_scattering(Cell cell, const std::vector<Rgb>& once);

    const Camera& camera_;
    Image image_;
    int beauty_ = -1, z_ = -1, albedo_ = -1;
    std::array<int, kCells> cells_;  // -1: no such layer
    // Single scattering of MV and MA per pixel, if PictureSettings::once is given.
    std::vector<Rgb> from_fire_, from_emitters_;
};

}  // namespace brisance
