#include "render/haze_lights.h"

#include <algorithm>

#include "render/outside_lights.h"

namespace brisance {

namespace {

// Optical depth across the finest lights, above which what their neighbourhood adds is more than a correction.
constexpr float kMostAcross = 0.1f;

bool thin_enough(const Medium& medium, const std::vector<std::uint32_t>& bricks) {
    float most = 0.0f;
    for (const std::uint32_t b : bricks) {
        const auto first = medium.extinction.begin() + std::ptrdiff_t(b) * BrickLattice::kNodes;
        most = std::max(most, *std::max_element(first, first + BrickLattice::kNodes));
    }
    return most * medium.spacing * float(1 << kFinestHazeLights) <= kMostAcross;
}

template <class T>
void move_bricks(const std::vector<std::uint32_t>& bricks, std::vector<T>& from, std::vector<T>& to, std::size_t width) {
    to.assign(from.size(), T(0.0f));
    for (const std::uint32_t b : from.empty() ? std::vector<std::uint32_t>{} : bricks) {
        const auto first = std::ptrdiff_t(b * width * BrickLattice::kNodes);
        const auto count = std::ptrdiff_t(width * BrickLattice::kNodes);
        std::copy_n(from.begin() + first, count, to.begin() + first);
        std::fill_n(from.begin() + first, count, T(0.0f));
    }
}

}  // namespace

std::unique_ptr<HazeLights> take_haze_lights(const Medium& medium, const std::vector<std::uint32_t>& bricks,
                                             HierarchyLights& from) {
    const int levels = static_cast<int>(from.grid.levels.size());
    if (levels <= kFinestHazeLights || !thin_enough(medium, bricks))
        return nullptr;
    const bool dark = std::none_of(bricks.begin(), bricks.end(), [&](std::uint32_t b) {
        const auto first = from.weight.begin() + std::ptrdiff_t(b) * BrickLattice::kNodes;
        return std::any_of(first, first + BrickLattice::kNodes, [](float w) { return w > 0.0f; });
    });
    if (dark)
        return nullptr;
    ScatteredLight taken;
    move_bricks(bricks, from.light.intensity, taken.intensity, 1);
    move_bricks(bricks, from.light.directional, taken.directional, 24);
    for (const std::uint32_t b : bricks)
        std::fill_n(from.weight.begin() + std::ptrdiff_t(b) * BrickLattice::kNodes, BrickLattice::kNodes, 0.0f);
    auto haze = std::make_unique<HazeLights>();
    haze->lights = build_hierarchy(medium, std::move(taken), levels);
    auto& grid = haze->lights.grid.levels;
    grid.erase(grid.begin(), grid.begin() + kFinestHazeLights - 1);
    drop_coarse_levels(haze->lights.grid, kLeastLightsForHaze);
    return haze;
}

}  // namespace brisance
