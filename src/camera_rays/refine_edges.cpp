#include "camera_rays/refine_edges.h"

#include <algorithm>
#include <cmath>

#include "camera_rays/primary_ray.h"
#include "core/parallel.h"

namespace brisance {

namespace {

// What one ray more or less may change a pixel by, over its luminance, that is not worth looking again.
constexpr float kUnseen = 0.01f;

// Of the sum of a pixel's weights.
constexpr float kRounding = 1e-5f;

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

}  // namespace

void refine_edges(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                  const std::vector<Glare>& glare, PictureWriter& writer) {
    const int width = camera.settings().width, height = camera.settings().height;
    PictureSettings own = settings;
    own.light_rays = {};  // random, and the same on average
    PictureSettings many = own;
    many.samples_per_axis *= settings.edge_refinement;
    many.medium_samples_per_axis = 0;
    const PixelRays own_rays(field, camera, own), many_rays(field, camera, many);
    std::vector<Pixel> edges;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (has_edge(writer, glare, width, height, {x, y}, own_rays.count()))
                edges.push_back({x, y});
    parallel_for(
        edges.size(),
        [&](std::size_t i) {
            const Pixel p = edges[i];
            RaySum difference = many_rays.trace(p.x, p.y, nullptr, nullptr);
            add_weighted(difference, own_rays.trace(p.x, p.y, nullptr, nullptr), -1.0f);
            if (std::abs(difference.alpha) < kRounding)
                difference.alpha = 0.0f;
            writer.add(p.x, p.y, difference);
        },
        kPixelsAtOnce);
}

}  // namespace brisance
