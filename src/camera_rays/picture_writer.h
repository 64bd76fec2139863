// Finished pixels to layers.
#pragma once

#include <array>
#include <vector>

#include "camera_rays/picture.h"
#include "film/image.h"

namespace brisance {

class PictureWriter {
public:
    // Keeps a reference to the camera. `settings`: which layers there are.
    PictureWriter(const Camera& camera, const PictureSettings& settings);

    void pixel(int x, int y, const RaySum& seen);
    // To all layers but Z, what more is known of a pixel.
    void add(int x, int y, const RaySum& more);
    float luminance_at(int x, int y) const;  // of the picture

    Image take();

private:
    void put(int layer, std::size_t pixel, const Rgb& c);
    void file_single_scattering(Cell cell, const std::vector<Rgb>& once);

    const Camera& camera_;
    Image image_;
    int beauty_ = -1, z_ = -1, albedo_ = -1;
    std::array<int, kCells> cells_;  // -1: no such layer
    // Per pixel, where PictureSettings::once is given: what scattered once of MV and of MA.
    std::vector<Rgb> from_fire_, from_emitters_;
};

}  // namespace brisance
