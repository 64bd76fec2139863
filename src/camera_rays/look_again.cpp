#include "camera_rays/look_again.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "camera_rays/primary_ray.h"
#include "core/parallel.h"

namespace brisance {

namespace {

// What one ray more or less may change a pixel by, over its luminance, that is not worth looking again.
constexpr float kUnseen = 0.01f;

// The second difference of pixels over the error of the mean of n * n rays, and how that falls with n: those of kinks
// and edges; a parabola has 24 and 2.
constexpr float kBend = 8.0f, kConvergence = 1.5f;

// Of the sum of a pixel's weights.
constexpr float kRounding = 1e-5f;

constexpr std::size_t kPixelsAtOnce = 64;

struct Pixel {
    int x, y;
};

bool has_edges(const PictureSettings& settings) {
    return settings.surroundings && settings.edge_refinement > 1;
}

int medium_samples(const PictureSettings& settings) {
    return settings.medium_samples_per_axis > 0 ? settings.medium_samples_per_axis : settings.samples_per_axis;
}

bool has_bends(const PictureSettings& settings) {
    return settings.tolerance > 0.0f && settings.finest_medium_samples_per_axis > medium_samples(settings);
}

// Between the ranges of two pixels; 0 where they overlap.
float gap(const Glare& a, const Glare& b) {
    return std::max({a.least - b.most, b.least - a.most, 0.0f});
}

// Which pixels want more rays, from what they and those beside them saw.
class SecondLooks {
public:
    SecondLooks(const std::vector<FirstLook>& first, int width, int height)
        : first_(first), width_(width), height_(height) {}

    // The pixel and those beside it: what its own rays have missed may show there.
    bool edge(const PictureWriter& writer, const Pixel& p, std::size_t rays) const {
        const Glare& own = at(p.x, p.y).glare;
        float step = 0.0f;
        for_neighbourhood(p, [&](int x, int y) {
            const Glare& g = at(x, y).glare;
            step = std::max({step, g.step, gap(own, g)});
        });
        return step > kUnseen * rays * mean_luminance(writer, p);
    }

    // Second difference at a pixel: relative to the mean luminance of these pixels, and of the transmittance to 1.
    float bend(const PictureWriter& writer, const Pixel& p) const {
        const float light = second_difference(p, &FirstLook::medium);
        return std::max(light > 0.0f ? light / mean_luminance(writer, p) : 0.0f,
                        second_difference(p, &FirstLook::through));
    }

private:
    // The picture goes on beyond its borders as it ends there.
    const FirstLook& at(int x, int y) const {
        return first_[std::size_t(std::clamp(y, 0, height_ - 1)) * width_ + std::clamp(x, 0, width_ - 1)];
    }

    template <class Visit>
    void for_neighbourhood(const Pixel& p, const Visit& visit) const {
        for (int y = std::max(p.y - 1, 0); y <= std::min(p.y + 1, height_ - 1); ++y)
            for (int x = std::max(p.x - 1, 0); x <= std::min(p.x + 1, width_ - 1); ++x)
                visit(x, y);
    }

    // Of the pixel and those beside it.
    float mean_luminance(const PictureWriter& writer, const Pixel& p) const {
        float sum = 0.0f;
        int count = 0;
        for_neighbourhood(p, [&](int x, int y) {
            sum += writer.luminance_at(x, y);
            ++count;
        });
        return sum / count;
    }

    // Of both axes together.
    float second_difference(const Pixel& p, float FirstLook::*value) const {
        const float twice = 2.0f * (at(p.x, p.y).*value);
        return std::abs(at(p.x - 1, p.y).*value + at(p.x + 1, p.y).*value - twice) +
               std::abs(at(p.x, p.y - 1).*value + at(p.x, p.y + 1).*value - twice);
    }

    const std::vector<FirstLook>& first_;
    int width_, height_;
};

PictureSettings for_edges(PictureSettings settings) {
    settings.samples_per_axis *= settings.edge_refinement;
    settings.medium_samples_per_axis = 0;
    return settings;
}

// `samples`: rays through the medium along a pixel's side.
PictureSettings for_bends(PictureSettings settings, int samples) {
    if (settings.medium_samples_per_axis > 0)
        settings.medium_samples_per_axis = samples;
    settings.samples_per_axis = std::max(settings.samples_per_axis, samples);
    return settings;
}

int samples_at(float bend, const PictureSettings& settings) {
    const float samples = std::pow(bend / (kBend * settings.tolerance), 1.0f / kConvergence);
    // In this order a bend that is not a number wants the most.
    return static_cast<int>(std::ceil(std::min(float(settings.finest_medium_samples_per_axis), samples)));
}

// Tile by tile.
template <class Visit>
void for_each_pixel_of_tiles(int width, int height, const Visit& visit) {
    for (int top = 0; top < height; top += kSideOfTile)
        for (int left = 0; left < width; left += kSideOfTile)
            for (int y = top; y < std::min(top + kSideOfTile, height); ++y)
                for (int x = left; x < std::min(left + kSideOfTile, width); ++x)
                    visit(x, y);
}

// Replaces what the pixels' own rays saw by what more rays see. `nothing_else`: a pixel is the sum of those rays alone.
void trace_again(const PixelRays& own, const PixelRays& more, const std::vector<Pixel>& pixels, bool nothing_else,
                 PictureWriter& writer) {
    parallel_for(
        pixels.size(),
        [&](std::size_t i) {
            const Pixel p = pixels[i];
            RaySum difference = more.trace(p.x, p.y, nullptr, nullptr);
            if (nothing_else)
                return writer.replace(p.x, p.y, difference);
            add_weighted(difference, own.trace(p.x, p.y, nullptr, nullptr), -1.0f);
            if (std::abs(difference.alpha) < kRounding)
                difference.alpha = 0.0f;
            writer.add(p.x, p.y, difference);
        },
        kPixelsAtOnce);
}

}  // namespace

bool looks_again(const PictureSettings& settings) {
    return has_edges(settings) || has_bends(settings);
}

void look_again(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                const std::vector<FirstLook>& first, PictureWriter& writer) {
    const int width = camera.settings().width, height = camera.settings().height;
    PictureSettings own = settings;
    own.light_rays = {};  // random, and the same on average
    const PixelRays own_rays(field, camera, own);
    const bool finds_edges = has_edges(settings), finds_bends = has_bends(settings);
    const bool nothing_else = !settings.surroundings && !settings.light_rays;
    const int few = medium_samples(settings);
    const SecondLooks looks(first, width, height);
    std::vector<Pixel> edges;
    std::map<int, std::vector<Pixel>> bends;  // by samples
    for_each_pixel_of_tiles(width, height, [&](int x, int y) {
        if (finds_edges && looks.edge(writer, {x, y}, own_rays.count()))
            edges.push_back({x, y});
        else if (const int samples = finds_bends ? samples_at(looks.bend(writer, {x, y}), settings) : 0; samples > few)
            bends[samples].push_back({x, y});
    });
    const PictureSettings at_edges = for_edges(own);
    trace_again(own_rays, PixelRays(field, camera, at_edges), edges, nothing_else, writer);
    for (const auto& [samples, pixels] : bends) {
        const PictureSettings at_bends = for_bends(own, samples);
        trace_again(own_rays, PixelRays(field, camera, at_bends), pixels, nothing_else, writer);
    }
}

}  // namespace brisance
