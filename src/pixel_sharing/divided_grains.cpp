#include "pixel_sharing/divided_grains.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace brisance {

namespace {

// What one pixel shows of a grain, over what is around, where pixels all around take part and the radius is not the
// widest [pixels].
constexpr float kShows = 0.05f;
constexpr float kLeastRadius = 3.5f, kMostRadius = 16.0f;

// Pixels of less weight than this are too few to divide a grain among.
constexpr float kFewPixels = 4.0f;

// On one surface, normals have at least this cosine, and points leave the plane by less than this part of the distance.
constexpr float kNormalOfSurface = 0.9f, kPlaneOfSurface = 0.1f;

// Weights are (1 - d^2 / r^2)^2: together a third of the circle.
float radius(float excess) {
    constexpr float kOfCircle = std::numbers::pi_v<float> / 3.0f;
    return std::clamp(std::sqrt(excess / (kShows * kOfCircle)), kLeastRadius, kMostRadius);
}

std::size_t index_of(Cell cell) {
    const auto found = std::ranges::find(DividedGrains::kOfSurfaces, cell);
    assert(found != DividedGrains::kOfSurfaces.end());
    return std::size_t(found - DividedGrains::kOfSurfaces.begin());
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

float DividedGrains::weight(const Grain& grain, const Spread& spread, int x, int y) const {
    const Surface& there = surfaces_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
    const auto dx = float(x - int(grain.pixel) % width_), dy = float(y - int(grain.pixel) / width_);
    const float within = 1.0f - (dx * dx + dy * dy) / (spread.radius * spread.radius);
    if (!(within > 0.0f) || !(there.share > 0.0f))
        return 0.0f;
    const bool takes_part = spread.who == TakesPart::All ||
                            (spread.who == TakesPart::Mesh && there.mesh == grain.surface.mesh) ||
                            on_one_surface(grain.surface, there);
    return takes_part ? there.share * within * within : 0.0f;
}

DividedGrains::Spread DividedGrains::spread(const Grain& grain) const {
    const float r = radius(grain.excess);
    const int x0 = int(grain.pixel) % width_, y0 = int(grain.pixel) / width_, reach = int(r);
    Spread out{TakesPart::Surface,
               r,
               0.0f,
               0.0f,
               std::max(x0 - reach, 0),
               std::min(x0 + reach, width_ - 1),
               std::max(y0 - reach, 0),
               std::min(y0 + reach, height_ - 1)};
    for (const TakesPart who : {TakesPart::Surface, TakesPart::Mesh, TakesPart::All}) {
        out.who = who;
        out.weights = out.squares = 0.0f;
        for (int y = out.top; y <= out.bottom; ++y)
            for (int x = out.left; x <= out.right; ++x) {
                const float w = weight(grain, out, x, y);
                out.weights += w;
                out.squares += w * w;
            }
        if (out.weights >= kFewPixels * surfaces_[grain.pixel].share)
            break;
    }
    return out;
}

void DividedGrains::divide() {
    spreads_.resize(grains_.size());
    parallel_for(
        grains_.size(), [&](std::size_t k) { spreads_[k] = spread(grains_[k]); }, 64);
}

// Row after row of what takes part, so that the order of the sums does not depend on threads.
std::vector<Rgb> DividedGrains::pixels(Cell cell) const {
    const std::size_t of = index_of(cell);
    std::vector<std::vector<std::uint32_t>> of_row(static_cast<std::size_t>(height_));
    for (std::size_t k = 0; k < spreads_.size(); ++k)
        if (grains_[k].light[of] != Rgb(0.0f))
            for (int y = spreads_[k].top; y <= spreads_[k].bottom; ++y)
                of_row[std::size_t(y)].push_back(std::uint32_t(k));
    std::vector<Rgb> out(surfaces_.size(), Rgb(0.0f));
    parallel_for(of_row.size(), [&](std::size_t y) {
        for (const std::uint32_t k : of_row[y])
            for (int x = spreads_[k].left; x <= spreads_[k].right; ++x)
                out[y * std::size_t(width_) + std::size_t(x)] +=
                    weight(grains_[k], spreads_[k], x, int(y)) / spreads_[k].weights * grains_[k].light[of];
    });
    return out;
}

double DividedGrains::square_error(Cell cell) const {
    const std::size_t of = index_of(cell);
    double sum = 0.0;
    for (std::size_t k = 0; k < spreads_.size(); ++k) {
        const Rgb& light = grains_[k].light[of];
        sum += double(glm::dot(light, light)) * spreads_[k].squares / (spreads_[k].weights * spreads_[k].weights);
    }
    return sum;
}

}  // namespace brisance
