#include "pixel_sharing/divided_grains.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace brisance {

namespace {

// A grain shows by this part of what is around at most, where it is no larger than the widest radius allows [pixels].
constexpr float kShows = 0.05f;
constexpr float kLeastRadius = 3.5f, kMostRadius = 16.0f;

// Pixels of less weight than this are too few to divide a grain among.
constexpr float kFewPixels = 4.0f;

// On one surface, normals have at least this cosine, and leave the plane by less than this part of the distance.
constexpr float kNormalOfSurface = 0.9f, kPlaneOfSurface = 0.1f;

// Weights are (1 - d^2 / r^2)^2: a third of the circle.
float radius(float excess) {
    constexpr float kOfCircle = std::numbers::pi_v<float> / 3.0f;
    // In this order what is infinite is divided as widely as can be.
    return std::max(kLeastRadius, std::min(kMostRadius, std::sqrt(excess / (kShows * kOfCircle))));
}

}  // namespace

bool DividedGrains::on_one_surface(const Surface& a, const Surface& b) {
    const vec3 apart = b.position - a.position;
    return a.mesh == b.mesh && glm::dot(a.normal, b.normal) > kNormalOfSurface &&
           std::abs(glm::dot(apart, a.normal)) <= kPlaneOfSurface * glm::length(apart);
}

DividedGrains::DividedGrains(int width, int height)
    : width_(width), height_(height), surfaces_(std::size_t(width) * std::size_t(height)) {}

std::uint64_t DividedGrains::bytes_of(int width, int height) {
    return std::uint64_t(width) * std::uint64_t(height) * (sizeof(Surface) + sizeof(Rgb));
}

DividedGrains::Window DividedGrains::window(const Grain& grain) const {
    const int x = int(grain.pixel) % width_, y = int(grain.pixel) / width_, reach = int(radius(grain.excess));
    return {std::max(x - reach, 0), std::min(x + reach, width_ - 1), std::max(y - reach, 0),
            std::min(y + reach, height_ - 1)};
}

float DividedGrains::in_common(const Grain& grain, int x, int y, bool mesh, bool others) const {
    const Surface& there = surfaces_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
    const auto dx = float(x - int(grain.pixel) % width_), dy = float(y - int(grain.pixel) / width_);
    const float r = radius(grain.excess), within = 1.0f - (dx * dx + dy * dy) / (r * r);
    if (!(within > 0.0f) || !(there.share > 0.0f))
        return 0.0f;
    const bool takes_part =
        others || (mesh && there.mesh == grain.surface.mesh) || on_one_surface(grain.surface, there);
    return takes_part ? there.share * within * within : 0.0f;
}

// Who takes part, and the sum of their weights. Where nobody does, not even its own pixel, a grain stays there.
DividedGrains::Spread DividedGrains::spread(const Grain& grain) const {
    const Window w = window(grain);
    Spread out;
    for (const bool others : {false, true})
        for (const bool mesh : {false, true}) {
            if (others && !mesh)
                continue;
            out = {mesh, others, 0.0f};
            for (int y = w.top; y <= w.bottom; ++y)
                for (int x = w.left; x <= w.right; ++x)
                    out.weights += in_common(grain, x, y, mesh, others);
            if (out.weights >= kFewPixels * surfaces_[grain.pixel].share)
                return out;
        }
    return out;
}

// Row after row of what receives, so that the order of the sums does not depend on threads.
std::vector<Rgb> DividedGrains::pixels(Cell cell) const {
    const auto of = std::size_t(std::ranges::find(kOfSurfaces, cell) - kOfSurfaces.begin());
    std::vector<Rgb> out(surfaces_.size(), Rgb(0.0f));
    if (of == kOfSurfaces.size() || grains_.empty())
        return out;
    std::vector<Spread> spreads(grains_.size());
    parallel_for(
        grains_.size(), [&](std::size_t k) { spreads[k] = spread(grains_[k]); }, 64);
    std::vector<std::vector<std::uint32_t>> of_row(static_cast<std::size_t>(height_));
    for (std::size_t k = 0; k < grains_.size(); ++k) {
        if (grains_[k].light[of] == Rgb(0.0f))
            continue;
        if (!(spreads[k].weights > 0.0f))
            out[grains_[k].pixel] += grains_[k].light[of];
        else
            for (int y = window(grains_[k]).top; y <= window(grains_[k]).bottom; ++y)
                of_row[std::size_t(y)].push_back(std::uint32_t(k));
    }
    parallel_for(of_row.size(), [&](std::size_t y) {
        for (const std::uint32_t k : of_row[y]) {
            const Grain& grain = grains_[k];
            const Window w = window(grain);
            for (int x = w.left; x <= w.right; ++x)
                out[y * std::size_t(width_) + std::size_t(x)] +=
                    in_common(grain, x, int(y), spreads[k].mesh, spreads[k].others) / spreads[k].weights *
                    grain.light[of];
        }
    });
    return out;
}

}  // namespace brisance
