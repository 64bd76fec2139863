#include "camera_rays/picture.h"

#include <algorithm>
#include <cmath>

#include "camera/pixel_samples.h"
#include "camera_rays/picture_writer.h"
#include "camera_rays/primary_ray.h"
#include "camera_rays/refine_edges.h"
#include "core/parallel.h"

namespace brisance {

namespace {

// A surface that one of a pixel's rays found, with how much of its light arrives.
struct FoundSurface {
    SurfaceSample sample;
    float weight;
};

// Rows of a picture together: their surfaces are lit in one call.
class Band {
public:
    Band(const SourceField& field, const Camera& camera, const PictureSettings& settings,
         const std::vector<PixelSample>& samples, const LightSurfaces& light_surfaces, std::vector<Glare>& glare)
        : field_(field),
          camera_(camera),
          settings_(settings),
          samples_(samples),
          light_surfaces_(light_surfaces),
          glare_(glare) {}

    void draw(int begin, int end, PictureWriter& writer) {
        const int width = camera_.settings().width;
        sums_.assign(std::size_t(end - begin) * width, RaySum{});
        std::vector<std::vector<FoundSurface>> rows(end - begin);
        parallel_for(end - begin, [&](std::size_t row) { draw_row(begin, static_cast<int>(row), rows[row]); });
        if (light_surfaces_)
            light(rows, begin);
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < width; ++x)
                writer.pixel(x, y, sums_[std::size_t(y - begin) * width + x]);
    }

private:
    void draw_row(int begin, int row, std::vector<FoundSurface>& found) {
        const int width = camera_.settings().width, y = begin + row;
        std::vector<float> direct(samples_.size());
        for (int x = 0; x < width; ++x) {
            const auto pixel = static_cast<std::uint32_t>(y * width + x);
            for (std::uint32_t k = 0; k < samples_.size(); ++k) {
                const PixelSample& s = samples_[k];
                const std::uint64_t number = static_cast<std::uint64_t>(settings_.pass) << 32 | k;
                const PixelRay ray{pixel, number, camera_.ray(x + 0.5 + s.x, y + 0.5 + s.y)};
                const PrimaryRay seen = trace_primary_ray(field_, ray, settings_);
                add_weighted(sums_[std::size_t(row) * width + x], seen.sum, s.weight);
                direct[k] = direct_luminance(seen.sum.cells);
                if (seen.surface)
                    found.push_back({{pixel, number, ray.ray, *seen.surface}, s.weight * std::exp(-seen.sum.depth)});
            }
            if (!glare_.empty())
                glare_[pixel] = glare_of(direct);
        }
    }

    void light(const std::vector<std::vector<FoundSurface>>& rows, int begin) {
        std::vector<SurfaceSample> all;
        for (const auto& row : rows)
            for (const FoundSurface& f : row)
                all.push_back(f.sample);
        std::vector<CellSum> lit(all.size());
        light_surfaces_(all, lit);
        std::size_t next = 0;
        const std::size_t first = std::size_t(begin) * camera_.settings().width;
        for (const auto& row : rows)
            for (const FoundSurface& f : row)
                sums_[f.sample.pixel - first].cells.add(lit[next++], Rgb(f.weight));
    }

    const SourceField& field_;
    const Camera& camera_;
    const PictureSettings& settings_;
    const std::vector<PixelSample>& samples_;
    const LightSurfaces& light_surfaces_;
    std::vector<Glare>& glare_;  // empty: not recorded
    std::vector<RaySum> sums_;
};

// Number of rays whose surfaces are lit together: enough for efficient gathers, few enough for memory.
constexpr std::size_t kRaysAtOnce = 1 << 18;

}  // namespace

int automatic_samples(const Camera& camera, const SourceField& field) {
    if (field.bricks().empty())
        return 1;
    const Medium& medium = field.medium();
    double nearest = 1e300;
    for (std::size_t b = 0; b < field.bricks().brick_count(); ++b) {
        const dvec3 centre(medium.local_of_node(field.bricks().first_node(b) + BrickLattice::kSize / 2));
        nearest = std::min(nearest, std::max(0.0, glm::dot(centre - camera.eye_local(), camera.forward())));
    }
    const double footprint = camera.pixel_angle() * nearest / medium.spacing;  // voxels per pixel
    return std::clamp(static_cast<int>(std::ceil(5.0 * std::min(footprint, 1e3))), 1, 8);
}

Image render_picture(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                     Progress& progress, const LightSurfaces& light_surfaces) {
    PictureWriter writer(camera, settings);
    const std::vector<PixelSample> samples = pixel_samples(camera.settings(), settings.samples_per_axis);
    const int width = camera.settings().width, height = camera.settings().height;
    const std::size_t per_row = std::max<std::size_t>(1, std::size_t(width) * samples.size());
    const int rows = static_cast<int>(std::clamp<std::size_t>(kRaysAtOnce / per_row, 1, height));
    const bool refines = settings.surroundings && settings.edge_refinement > 1;
    std::vector<Glare> glare(refines ? std::size_t(width) * height : 0);
    Band band(field, camera, settings, samples, light_surfaces, glare);
    for (int y = 0; y < height; y += rows) {
        band.draw(y, std::min(y + rows, height), writer);
        progress.fraction(double(std::min(y + rows, height)) / height);
    }
    if (refines)
        refine_edges(field, camera, settings, samples, glare, writer);
    return writer.take();
}

}  // namespace brisance
