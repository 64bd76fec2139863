#include "camera_rays/picture.h"

#include <algorithm>
#include <cmath>

#include "camera_rays/look_again.h"
#include "camera_rays/picture_writer.h"
#include "camera_rays/pixel_rays.h"
#include "core/parallel.h"

namespace brisance {

namespace {

float luminance_of_medium(const CellSum& cells) {
    float sum = 0.0f;
    for (const Cell cell : {Cell::V, Cell::MV, Cell::MM, Cell::MS, Cell::MA})
        sum += luminance(cells.at(cell));
    return sum;
}

// Rows of a picture together: their surfaces are lit in one call. They are traced in tiles.
class Band {
public:
    Band(const PixelRays& rays, int width, const LightSurfaces& light_surfaces, std::vector<FirstLook>& first)
        : rays_(rays), width_(width), light_surfaces_(light_surfaces), first_(first) {}

    void draw(int begin, int end, PictureWriter& writer) {
        sums_.assign(std::size_t(end - begin) * width_, RaySum{});
        const int columns = (width_ + kSideOfTile - 1) / kSideOfTile,
                  rows = (end - begin + kSideOfTile - 1) / kSideOfTile;
        Found found(std::size_t(end - begin) * columns);
        parallel_for(std::size_t(rows) * columns, [&](std::size_t tile) {
            const int column = static_cast<int>(tile) % columns,
                      first = begin + static_cast<int>(tile) / columns * kSideOfTile;
            for (int y = first; y < std::min(first + kSideOfTile, end); ++y)
                draw_row_of_tile(begin, y, column, found[std::size_t(y - begin) * columns + column]);
        });
        if (light_surfaces_)
            light(found, begin);
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < width_; ++x)
                writer.pixel(x, y, sums_[std::size_t(y - begin) * width_ + x]);
    }

private:
    // What the rays of each tile's rows found; in the order of pixels.
    using Found = std::vector<std::vector<FoundSurface>>;

    // `begin`: first row of the band.
    void draw_row_of_tile(int begin, int y, int column, std::vector<FoundSurface>& found) {
        for (int x = column * kSideOfTile; x < std::min((column + 1) * kSideOfTile, width_); ++x) {
            FirstLook* const look = first_.empty() ? nullptr : &first_[std::size_t(y) * width_ + x];
            RaySum& sum = sums_[std::size_t(y - begin) * width_ + x];
            sum = rays_.trace(x, y, &found, look ? &look->glare : nullptr);
            if (look) {
                look->medium = luminance_of_medium(sum.cells);
                look->through = sum.through;
            }
        }
    }

    void light(const Found& found, int begin) {
        const std::size_t first = std::size_t(begin) * width_;
        std::vector<SurfaceSample> all;
        for (const auto& some : found)
            for (const FoundSurface& f : some)
                all.push_back({f.sample.pixel, f.sample.number, f.sample.ray, f.sample.hit, f.weight,
                               luminance(sums_[f.sample.pixel - first].cells)});
        std::vector<CellSum> lit(all.size());
        light_surfaces_(all, lit);
        std::size_t next = 0;
        for (const auto& some : found)
            for (const FoundSurface& f : some)
                sums_[f.sample.pixel - first].cells.add(lit[next++], Rgb(f.weight));
    }

    const PixelRays& rays_;
    int width_;
    const LightSurfaces& light_surfaces_;
    std::vector<FirstLook>& first_;  // empty: not recorded
    std::vector<RaySum> sums_;
};

// Number of rays whose surfaces are lit together: enough for efficient gathers, few enough for memory.
constexpr std::size_t kRaysAtOnce = 1 << 18;

}  // namespace

int rows_at_once(int width, int height, std::size_t rays) {
    const std::size_t per_row = std::max<std::size_t>(1, std::size_t(width) * rays);
    return static_cast<int>(std::clamp<std::size_t>(kRaysAtOnce / per_row, 1, std::size_t(height)));
}

Image render_picture(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                     Progress& progress, const LightSurfaces& light_surfaces) {
    PictureWriter writer(camera, settings);
    const PixelRays pixel_rays(field, camera, settings);
    const int width = camera.settings().width, height = camera.settings().height;
    const int rows = rows_at_once(width, height, pixel_rays.count());
    std::vector<FirstLook> first(looks_again(settings) ? std::size_t(width) * height : 0);
    Band band(pixel_rays, width, light_surfaces, first);
    for (int y = 0; y < height; y += rows) {
        band.draw(y, std::min(y + rows, height), writer);
        progress.fraction(double(std::min(y + rows, height)) / height);
    }
    if (!first.empty())
        look_again(field, camera, settings, first, writer);
    return writer.take();
}

}  // namespace brisance
