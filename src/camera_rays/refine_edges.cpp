#include "camera_rays/refine_edges.h"

#include <algorithm>
#include <cmath>

#include "camera_rays/primary_ray.h"
#include "core/parallel.h"

namespace brisance {

namespace {

// What one ray more or less may change a pixel by, over its luminance, that is not worth looking again.
constexpr float kUnseen = 0.01f;

constexpr std::size_t kPixelsAtOnce = 8;

struct Pixel {
    int x, y;
};

// Between the ranges of two pixels; 0 where they overlap.
float gap(const Glare& a, const Glare& b) {
    return std::max({a.least - b.most, b.least - a.most, 0.0f});
}

// The pixel and those beside it: what its own rays have missed may show there.
bool has_edge(const PictureWriter& writer, const std::vector<Glare>& glare, int width, int height, Pixel p,
              std::size_t rays) {
    const Glare& own = glare[std::size_t(p.y) * width + p.x];
    float step = 0.0f, sum = 0.0f;
    int count = 0;
    for (int y = std::max(p.y - 1, 0); y <= std::min(p.y + 1, height - 1); ++y)
        for (int x = std::max(p.x - 1, 0); x <= std::min(p.x + 1, width - 1); ++x, ++count) {
            const Glare& g = glare[std::size_t(y) * width + x];
            step = std::max({step, g.step, gap(own, g)});
            sum += writer.luminance_at(x, y);
        }
    return step > kUnseen * rays * sum / count;
}

void look(const SourceField& field, const Camera& camera, const PictureSettings& settings, Pixel p,
          const std::vector<PixelSample>& samples, float sign, RaySum& sum) {
    for (const PixelSample& s : samples) {
        const PixelRay ray{0, 0, camera.ray(p.x + 0.5 + s.x, p.y + 0.5 + s.y)};
        RaySum seen = trace_primary_ray(field, ray, settings).sum;
        seen.alpha -= 1.0f;  // the same for the difference, and exact where all is covered
        add_weighted(sum, seen, sign * s.weight);
    }
}

}  // namespace

float direct_luminance(const CellSum& seen) {
    return luminance(seen.at(Cell::V) + seen.at(Cell::A));
}

Glare glare_of(std::span<const float> luminances) {
    const auto [least, most] = std::minmax_element(luminances.begin(), luminances.end());
    Glare glare{*least, *most, 0.0f};
    const auto n = static_cast<std::size_t>(std::lround(std::sqrt(double(luminances.size()))));
    for (std::size_t i = 0; i < luminances.size(); ++i) {
        if (i % n != 0)
            glare.step = std::max(glare.step, std::abs(luminances[i] - luminances[i - 1]));
        if (i >= n)
            glare.step = std::max(glare.step, std::abs(luminances[i] - luminances[i - n]));
    }
    return glare;
}

void refine_edges(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                  const std::vector<PixelSample>& samples, const std::vector<Glare>& glare, PictureWriter& writer) {
    const int width = camera.settings().width, height = camera.settings().height;
    std::vector<Pixel> edges;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (has_edge(writer, glare, width, height, {x, y}, samples.size()))
                edges.push_back({x, y});
    PictureSettings steady = settings;
    steady.light_rays = {};  // random, and the same on average
    const auto more = pixel_samples(camera.settings(), settings.samples_per_axis * settings.edge_refinement);
    parallel_for(
        edges.size(),
        [&](std::size_t i) {
            RaySum difference;
            look(field, camera, steady, edges[i], more, 1.0f, difference);
            look(field, camera, steady, edges[i], samples, -1.0f, difference);
            writer.add(edges[i].x, edges[i].y, difference);
        },
        kPixelsAtOnce);
}

}  // namespace brisance
