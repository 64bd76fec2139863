#include "thin_media/thin_medium_lights.h"

#include <algorithm>
#include <iterator>

#include "thin_media/exterior_hierarchy.h"

namespace brisance {

namespace {

// Largest optical depth across the finest lights; above it the light of their neighbourhood is more than a correction.
constexpr float kMostAcross = 0.1f;

std::vector<std::uint32_t> thin_enough(const Medium& medium, const std::vector<std::uint32_t>& bricks) {
    const float most = kMostAcross / (medium.spacing * float(1 << kFinestThinLights));
    std::vector<std::uint32_t> thin;
    std::copy_if(bricks.begin(), bricks.end(), std::back_inserter(thin), [&](std::uint32_t b) {
        const auto first = medium.extinction.begin() + std::ptrdiff_t(b) * BrickLattice::kNodes;
        return *std::max_element(first, first + BrickLattice::kNodes) <= most;
    });
    return thin;
}

// `width` values per node.
template <class T>
void copy_bricks(const std::vector<std::uint32_t>& bricks, const std::vector<T>& from, std::vector<T>& to,
                 std::size_t width) {
    const std::size_t count = from.empty() ? 0 : width * BrickLattice::kNodes;
    for (const std::uint32_t b : bricks)
        std::copy_n(from.begin() + std::ptrdiff_t(b * count), count, to.begin() + std::ptrdiff_t(b * count));
}

template <class T>
std::vector<T> take_bricks(const std::vector<std::uint32_t>& bricks, std::vector<T>& from, std::size_t width) {
    std::vector<T> taken(from.size(), T(0.0f));
    copy_bricks(bricks, from, taken, width);
    const std::size_t count = from.empty() ? 0 : width * BrickLattice::kNodes;
    for (const std::uint32_t b : bricks)
        std::fill_n(from.begin() + std::ptrdiff_t(b * count), count, T(0.0f));
    return taken;
}

}  // namespace

std::unique_ptr<ThinMediumLights> take_thin_medium_lights(const Medium& medium, const std::vector<std::uint32_t>& even,
                                                          HierarchyLights& from) {
    const int levels = static_cast<int>(from.grid.levels.size());
    if (levels <= kFinestThinLights)
        return nullptr;
    std::vector<std::uint32_t> bricks = thin_enough(medium, even);
    const bool dark = std::none_of(bricks.begin(), bricks.end(), [&](std::uint32_t b) {
        const auto first = from.weight.begin() + std::ptrdiff_t(b) * BrickLattice::kNodes;
        return std::any_of(first, first + BrickLattice::kNodes, [](float w) { return w > 0.0f; });
    });
    if (dark)
        return nullptr;
    ScatteredLight taken{take_bricks(bricks, from.light.intensity, 1), take_bricks(bricks, from.light.directional, 24)};
    from = build_hierarchy(medium, std::move(from.light), levels);
    auto thin = std::make_unique<ThinMediumLights>();
    thin->lights = build_hierarchy(medium, std::move(taken), levels);
    auto& grid = thin->lights.grid.levels;
    grid.erase(grid.begin(), grid.begin() + kFinestThinLights - 1);
    thin->bricks = std::move(bricks);
    return thin;
}

void give_back(const ThinMediumLights& taken, ScatteredLight& light) {
    copy_bricks(taken.bricks, taken.lights.light.intensity, light.intensity, 1);
    copy_bricks(taken.bricks, taken.lights.light.directional, light.directional, 24);
}

}  // namespace brisance
