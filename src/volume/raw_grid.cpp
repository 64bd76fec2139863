// Two passes over leaves and tiles: one that counts, one that copies. Partial results are kept per leaf and added in
// the order of the file, so that no thread can change a sum.
#include "volume/raw_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <new>

#include "core/error.h"
#include "core/parallel.h"

namespace brisance {
namespace {

constexpr int kBlock = BlockGrid::kBlock;
constexpr std::size_t kVoxels = kBlock * kBlock * kBlock;
constexpr std::size_t kLeavesPerTask = 64;
constexpr int kFarthest = 1 << 30;         // index coordinates beyond this overflow 32-bit differences
constexpr std::int64_t kWidest = 1 << 20;  // no simulation is a million voxels wide: a stray voxel is

// What one leaf or tile adds to the census.
struct Tally {
    std::uint64_t active = 0, bad = 0, negative = 0;
    double minimum = std::numeric_limits<double>::infinity();
    double maximum = -std::numeric_limits<double>::infinity();
    double sum = 0.0;
    bool all_zero = true;
    ivec3 low{std::numeric_limits<int>::max()};
    ivec3 high{std::numeric_limits<int>::min()};  // inclusive

    void add(const Tally& other) {
        active += other.active;
        bad += other.bad;
        negative += other.negative;
        minimum = std::min(minimum, other.minimum);
        maximum = std::max(maximum, other.maximum);
        sum += other.sum;
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
};

// One voxel as floats: the value counted for the census, or nothing when it is not finite.
template <int Channels, class T>
struct Voxel {
    float value[Channels];
    bool finite = true;

    explicit Voxel(const T* stored) {
        for (int c = 0; c < Channels; ++c) {
            value[c] = static_cast<float>(stored[c]);
            finite = finite && std::isfinite(value[c]);
        }
    }
    double measure() const {
        if constexpr (Channels == 1)
            return value[0];
        double square = 0.0;
        for (const float v : value)
            square += static_cast<double>(v) * v;
        return std::sqrt(square);
    }
    bool any_negative() const {
        return std::any_of(value, value + Channels, [](float v) { return v < 0.0f; });
    }
};

template <int Channels, class T>
void tally_voxel(const T* stored, std::uint64_t times, Tally& tally) {
    const Voxel<Channels, T> voxel(stored);
    tally.active += times;
    if (!voxel.finite) {
        tally.bad += times;
        return;
    }
    const double measure = voxel.measure();
    tally.negative += voxel.any_negative() ? times : 0;
    tally.minimum = std::min(tally.minimum, measure);
    tally.maximum = std::max(tally.maximum, measure);
    tally.sum += measure * static_cast<double>(times);
    tally.all_zero = tally.all_zero && measure == 0.0;
}

void tally_bounds(const ivec3& origin, const std::uint64_t (&active)[8], Tally& tally) {
    std::uint64_t any = 0;
    int x_low = kBlock, x_high = -1;
    for (int x = 0; x < kBlock; ++x) {
        any |= active[x];
        if (active[x] != 0) {
            x_low = std::min(x_low, x);
            x_high = x;
        }
    }
    if (any == 0)
        return;
    std::uint64_t z = any;  // fold the rows of y onto the lowest byte
    z |= z >> 32;
    z |= z >> 16;
    z |= z >> 8;
    const auto z_bits = static_cast<std::uint8_t>(z);
    tally.low = origin + ivec3(x_low, std::countr_zero(any) / kBlock, std::countr_zero(z_bits));
    tally.high = origin + ivec3(x_high, 7 - std::countl_zero(any) / kBlock, 7 - std::countl_zero(z_bits));
}

template <class Visit>
void for_active(const std::uint64_t (&active)[8], const Visit& visit) {
    for (std::size_t word = 0; word < 8; ++word)
        for (std::uint64_t bits = active[word]; bits != 0; bits &= bits - 1)
            visit(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
}

template <int Channels, class T>
Tally tally_leaf(const RawLeaf<T>& leaf) {
    Tally tally;
    for_active(leaf.active, [&](std::size_t i) { tally_voxel<Channels>(leaf.values + i * Channels, 1, tally); });
    tally_bounds(leaf.origin, leaf.active, tally);
    return tally;
}

template <int Channels, class T>
Tally tally_tile(const RawTile<T>& tile) {
    Tally tally;
    const auto width = static_cast<std::uint64_t>(tile.width);
    tally_voxel<Channels>(tile.value, width * width * width, tally);
    tally.low = tile.origin;
    tally.high = tile.origin + (tile.width - 1);
    return tally;
}

template <class T>
struct Tallies {
    std::vector<Tally> leaves;
    std::vector<Tally> tiles;
    Tally total;
};

template <int Channels, class T>
Tallies<T> tally_all(const RawGrid<T>& grid) {
    Tallies<T> result;
    result.leaves.resize(grid.leaves.size());
    result.tiles.reserve(grid.tiles.size());
    parallel_for(
        grid.leaves.size(), [&](std::size_t i) { result.leaves[i] = tally_leaf<Channels>(grid.leaves[i]); },
        kLeavesPerTask);
    for (const RawTile<T>& tile : grid.tiles)
        result.tiles.push_back(tally_tile<Channels>(tile));
    for (const Tally& tally : result.leaves)
        result.total.add(tally);
    for (const Tally& tally : result.tiles)
        result.total.add(tally);
    return result;
}

GridCensus census_from(const Tally& total, std::uint64_t tiles) {
    GridCensus census;
    census.active_voxels = total.active;
    census.active_tiles = tiles;
    census.nan_voxels = total.bad;
    census.negative_voxels = total.negative;
    if (const std::uint64_t counted = total.active - total.bad; counted > 0) {
        census.minimum = total.minimum;
        census.maximum = total.maximum;
        census.mean = total.sum / static_cast<double>(counted);
    }
    return census;
}

template <int Channels, class T>
void fill_histogram(const RawGrid<T>& grid, int bins, GridCensus& census) {
    const auto count = static_cast<std::size_t>(bins);
    const double range = census.maximum - census.minimum;
    const double scale = range > 0.0 ? bins / range : 0.0;
    const auto put = [&](const T* stored, std::uint64_t times, std::vector<std::uint64_t>& histogram) {
        const Voxel<Channels, T> voxel(stored);
        if (!voxel.finite)
            return;
        const double bin = (voxel.measure() - census.minimum) * scale;
        histogram[std::min(static_cast<std::size_t>(std::max(bin, 0.0)), count - 1)] += times;
    };
    constexpr std::size_t per_part = 1024;
    std::vector<std::vector<std::uint64_t>> parts((grid.leaves.size() + per_part - 1) / per_part);
    parallel_blocks(grid.leaves.size(), per_part, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint64_t> histogram(count);
        for (std::size_t i = begin; i < end; ++i) {
            const RawLeaf<T>& leaf = grid.leaves[i];
            for_active(leaf.active, [&](std::size_t v) { put(leaf.values + v * Channels, 1, histogram); });
        }
        parts[begin / per_part] = std::move(histogram);
    });
    census.histogram.assign(count, 0);
    for (const std::vector<std::uint64_t>& part : parts)
        for (std::size_t b = 0; b < count; ++b)
            census.histogram[b] += part[b];
    for (const RawTile<T>& tile : grid.tiles)
        put(tile.value, static_cast<std::uint64_t>(tile.width) * tile.width * tile.width, census.histogram);
}

void check_bounds(const Tally& total, const std::string& where) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t low = total.low[axis], high = total.high[axis];
        if (high < low || (high - low < kWidest && low >= -kFarthest && high < kFarthest))
            continue;
        throw Error(ExitCode::BadData,
                    fmt::format("{}: its active voxels span {}..{} along {}, {} voxels: stray voxels, most likely; at "
                                "most {} voxels within +-{} can be read; clip the grid where it was made",
                                where, low, high, "xyz"[axis], high - low + 1, kWidest, kFarthest));
    }
}

// A block to be written: the leaf or tile it comes from.
struct BlockSource {
    ivec3 origin;
    std::int64_t index;  // of the leaf, or -1 - (that of the tile)
};

template <class T>
void check_memory(const RawGrid<T>& grid, const Tallies<T>& tallies, std::uint64_t limit, const std::string& where) {
    std::uint64_t leaves = 0, from_tiles = 0;
    for (const Tally& tally : tallies.leaves)
        leaves += tally.all_zero ? 0 : 1;
    for (std::size_t i = 0; i < grid.tiles.size(); ++i) {
        const auto along = static_cast<std::uint64_t>(grid.tiles[i].width / kBlock);
        from_tiles += tallies.tiles[i].all_zero ? 0 : along * along * along;
    }
    const std::uint64_t bytes_per_block =
        kVoxels * sizeof(float) * static_cast<std::uint64_t>(grid.channels) + sizeof(ivec3);
    const double bytes = static_cast<double>(leaves + from_tiles) * static_cast<double>(bytes_per_block);
    if (bytes <= static_cast<double>(limit))
        return;
    throw Error(ExitCode::BadData,
                fmt::format("{}: needs {:.1f} MiB ({} blocks of 8^3 voxels and {} more where {} constant tiles are "
                            "expanded), the limit is {:.1f} MiB; {}, or raise the limit",
                            where, bytes / 1048576.0, leaves, from_tiles, grid.tiles.size(),
                            static_cast<double>(limit) / 1048576.0,
                            from_tiles > leaves ? "clip or deactivate the constant regions where it was made"
                                                : "write the grid with larger voxels"));
}

template <class T>
std::vector<BlockSource> list_blocks(const RawGrid<T>& grid, const Tallies<T>& tallies) {
    std::vector<BlockSource> sources;
    for (std::size_t i = 0; i < grid.leaves.size(); ++i)
        if (!tallies.leaves[i].all_zero)
            sources.push_back({grid.leaves[i].origin, static_cast<std::int64_t>(i)});
    for (std::size_t i = 0; i < grid.tiles.size(); ++i) {
        const RawTile<T>& tile = grid.tiles[i];
        for (int x = 0; x < tile.width && !tallies.tiles[i].all_zero; x += kBlock)
            for (int y = 0; y < tile.width; y += kBlock)
                for (int z = 0; z < tile.width; z += kBlock)
                    sources.push_back({tile.origin + ivec3(x, y, z), -1 - static_cast<std::int64_t>(i)});
    }
    std::sort(sources.begin(), sources.end(), [](const BlockSource& a, const BlockSource& b) {
        if (a.origin.x != b.origin.x)
            return a.origin.x < b.origin.x;
        return a.origin.y != b.origin.y ? a.origin.y < b.origin.y : a.origin.z < b.origin.z;
    });
    return sources;
}

template <int Channels, class T>
void copy_voxel(const T* stored, float* to) {
    const Voxel<Channels, T> voxel(stored);
    if (voxel.finite)
        std::copy(voxel.value, voxel.value + Channels, to);
}

// `to` holds zeros.
template <int Channels, class T>
void copy_block(const RawGrid<T>& grid, std::int64_t source, float* to) {
    if (source >= 0) {
        const RawLeaf<T>& leaf = grid.leaves[static_cast<std::size_t>(source)];
        for_active(leaf.active,
                   [&](std::size_t i) { copy_voxel<Channels>(leaf.values + i * Channels, to + i * Channels); });
        return;
    }
    const RawTile<T>& tile = grid.tiles[static_cast<std::size_t>(-1 - source)];
    for (std::size_t i = 0; i < kVoxels; ++i)
        copy_voxel<Channels>(tile.value, to + i * Channels);
}

template <int Channels, class T>
BlockGrid expand(const RawGrid<T>& grid, const GridInfo& info, std::uint64_t limit, const std::string& where) {
    const Tallies<T> tallies = tally_all<Channels>(grid);
    check_bounds(tallies.total, where);
    check_memory(grid, tallies, limit, where);
    const std::vector<BlockSource> sources = list_blocks(grid, tallies);
    BlockGrid result;
    result.info = info;
    const bool none = tallies.total.active == 0;
    result.info.active_min = none ? ivec3(0) : tallies.total.low;
    result.info.active_max = none ? ivec3(-1) : tallies.total.high;
    result.census = census_from(tallies.total, grid.tiles.size());
    result.channels = Channels;
    result.block_origin.resize(sources.size());
    result.values.resize(sources.size() * kVoxels * Channels);
    parallel_for(
        sources.size(),
        [&](std::size_t b) {
            result.block_origin[b] = sources[b].origin;
            copy_block<Channels>(grid, sources[b].index, result.values.data() + b * kVoxels * Channels);
        },
        kLeavesPerTask);
    return result;
}

}  // namespace

GridCensus count_voxels(const AnyRawGrid& any, int bins) {
    return std::visit(
        [&](const auto& grid) {
            const bool scalar = grid.channels == 1;
            const Tally total = scalar ? tally_all<1>(grid).total : tally_all<3>(grid).total;
            GridCensus census = census_from(total, grid.tiles.size());
            if (bins > 0)
                scalar ? fill_histogram<1>(grid, bins, census) : fill_histogram<3>(grid, bins, census);
            return census;
        },
        any);
}

BlockGrid expand_blocks(const AnyRawGrid& any, const GridInfo& info, std::uint64_t memory_limit_bytes,
                        const std::string& where) try {
    return std::visit(
        [&](const auto& grid) {
            return grid.channels == 1 ? expand<1>(grid, info, memory_limit_bytes, where)
                                      : expand<3>(grid, info, memory_limit_bytes, where);
        },
        any);
} catch (const std::bad_alloc&) {
    throw Error(ExitCode::Temporary, where + ": out of memory while reading; lower the memory limit or free memory");
}

}  // namespace brisance
