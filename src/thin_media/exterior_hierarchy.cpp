#include "thin_media/exterior_hierarchy.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <tuple>

#include "gathering/escape_probability.h"

namespace brisance {

namespace {

// Of all that is sent to the outside.
constexpr double kLostShare = 1e-3;

// Lights at the middle of what they send to the outside, not of all they send.
void move_to_skin(HierarchyLights& lights, const Medium& medium, const NodeWeights& escape) {
    const NodeWeights weight = escape_density(lights.light.intensity, escape);
    const int levels = static_cast<int>(lights.grid.levels.size());
    lights.grid = build_lighting_grid(medium, lights.light.intensity, &weight, levels);
    if (!lights.light.directional.empty())
        set_intensity(lights.grid, medium.lattice, lights.light.intensity, &lights.light.directional);
}

// What a light may send to the outside, summed as its intensity is, of every light of a level.
std::vector<float> escaping(const GridLevel& level, const GridLevel& of_skin) {
    std::vector<float> sums(level.size(), 0.0f);
    std::size_t at = 0;
    const auto before = [](const ivec3& a, const ivec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    for (std::size_t i = 0; i < level.size(); ++i) {
        while (at < of_skin.size() && before(of_skin.vertex[at], level.vertex[i]))
            ++at;
        if (at < of_skin.size() && of_skin.vertex[at] == level.vertex[i])
            sums[i] = luminance(of_skin.intensity[at]);
    }
    return sums;
}

void keep_lights(GridLevel& level, const std::vector<std::uint32_t>& kept) {
    assert(level.first_part.empty());  // lights of voxels have no parts to be kept
    GridLevel out = level;
    const auto take = [&](auto& from, auto& to, std::size_t width) {
        to.clear();
        for (const std::uint32_t i : kept)
            to.insert(to.end(), from.begin() + i * width, from.begin() + (i + 1) * width);
    };
    take(level.vertex, out.vertex, 1);
    take(level.position, out.position, 1);
    take(level.intensity, out.intensity, 1);
    take(level.node, out.node, 1);
    take(level.escaping, out.escaping, 1);
    if (!level.directional.empty())
        take(level.directional, out.directional, 24);
    out.index_rows();
    level = std::move(out);
}

// Drops, of every level, the lights deep in the smoke that together send less than kLostShare to the outside.
void drop_hidden_lights(HierarchyLights& lights, const Medium& medium, const NodeWeights& escape) {
    std::vector<Rgb> skin = lights.light.intensity;
    for (std::size_t i = 0; i < skin.size(); ++i)
        skin[i] *= escape[i];
    const int levels = static_cast<int>(lights.grid.levels.size());
    const LightingGrid of_skin = build_lighting_grid(medium, skin, nullptr, levels);
    for (int l = 0; l < levels; ++l) {
        GridLevel& level = lights.grid.levels[l];
        const std::vector<float> sums = escaping(level, of_skin.levels[l]);
        std::vector<std::uint32_t> order(level.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return sums[a] < sums[b]; });
        double most = kLostShare * std::accumulate(sums.begin(), sums.end(), 0.0);
        std::size_t lost = 0;
        while (lost < order.size() && (most -= sums[order[lost]]) >= 0.0)
            ++lost;
        order.erase(order.begin(), order.begin() + lost);
        std::sort(order.begin(), order.end());
        level.escaping = sums;  // of which shadow maps make a number of rays
        keep_lights(level, order);
    }
}

}  // namespace

void place_for_exterior(HierarchyLights& lights, const Medium& medium, const NodeWeights& escape) {
    move_to_skin(lights, medium, escape);
    drop_hidden_lights(lights, medium, escape);
    drop_coarse_levels(lights.grid, kLeastLightsForThinMedium);
}

void drop_coarse_levels(LightingGrid& grid, std::size_t least) {
    while (grid.levels.size() > 1 && grid.levels.back().size() < least)
        grid.levels.pop_back();
}

}  // namespace brisance
