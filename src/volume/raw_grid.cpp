#include "volume/raw_grid.h"

#include "volume/voxel_tally.h"

namespace brisance {
namespace {

template <int Channels, class T>
GridCensus count(const RawGrid<T>& grid) {
    Tally total;
    grid.visit_leaves([&](std::size_t first, std::size_t leaves, const T* values) {
        for (const Tally& tally : tally_leaves<Channels>(grid, first, leaves, values))
            total.add(tally);
    });
    for (const Tally& tally : tally_tiles<Channels>(grid))
        total.add(tally);
    return census_from(total, grid.tiles.size());
}

template <int Channels, class T>
void fill_histogram(const RawGrid<T>& grid, int bins, GridCensus& census) {
    const auto most = static_cast<std::size_t>(bins) - 1;
    const double range = census.maximum - census.minimum;
    const double scale = range > 0.0 ? bins / range : 0.0;
    census.histogram.assign(most + 1, 0);
    const auto put = [&](const T* stored, std::uint64_t times) {
        const Voxel<Channels, T> voxel(stored);
        if (!voxel.finite)
            return;
        const double bin = (voxel.measure() - census.minimum) * scale;
        census.histogram[std::min(static_cast<std::size_t>(std::max(bin, 0.0)), most)] += times;
    };
    grid.visit_leaves([&](std::size_t first, std::size_t leaves, const T* values) {
        for (std::size_t i = 0; i < leaves; ++i)
            for_active(grid.leaves[first + i].active,
                       [&](std::size_t v) { put(values + (i * kLeafVoxels + v) * Channels, 1); });
    });
    for (const RawTile<T>& tile : grid.tiles)
        put(tile.value, static_cast<std::uint64_t>(tile.width) * tile.width * tile.width);
}

}  // namespace

bool comes_before(const ivec3& a, const ivec3& b) {
    if (a.x != b.x)
        return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}

GridCensus count_voxels(const AnyRawGrid& any, int bins) {
    return std::visit(
        [&](const auto& grid) {
            const bool scalar = grid.channels == 1;
            GridCensus census = scalar ? count<1>(grid) : count<3>(grid);
            if (bins > 0)
                scalar ? fill_histogram<1>(grid, bins, census) : fill_histogram<3>(grid, bins, census);
            return census;
        },
        any);
}

}  // namespace brisance
