// What voxels add to the census of their grid.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/parallel.h"
#include "volume/raw_grid.h"

namespace brisance {

constexpr std::size_t kLeafVoxels = BlockGrid::kBlock * BlockGrid::kBlock * BlockGrid::kBlock;
constexpr std::size_t kLeavesPerTask = 32;

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

inline void tally_bounds(const ivec3& origin, const std::uint64_t (&active)[8], Tally& tally) {
    std::uint64_t any = 0;
    int x_low = BlockGrid::kBlock, x_high = -1;
    for (int x = 0; x < BlockGrid::kBlock; ++x) {
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
    tally.low = origin + ivec3(x_low, std::countr_zero(any) / BlockGrid::kBlock, std::countr_zero(z_bits));
    tally.high = origin + ivec3(x_high, 7 - std::countl_zero(any) / BlockGrid::kBlock, 7 - std::countl_zero(z_bits));
}

template <class Visit>
void for_active(const std::uint64_t (&active)[8], const Visit& visit) {
    for (std::size_t word = 0; word < 8; ++word)
        for (std::uint64_t bits = active[word]; bits != 0; bits &= bits - 1)
            visit(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
}

template <int Channels, class T>
Tally tally_leaf(const RawLeaf& leaf, const T* values) {
    Tally tally;
    for_active(leaf.active, [&](std::size_t i) { tally_voxel<Channels>(values + i * Channels, 1, tally); });
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

template <int Channels, class T>
std::vector<Tally> tally_leaves(const RawGrid<T>& grid, std::size_t first, std::size_t count, const T* values) {
    std::vector<Tally> tallies(count);
    parallel_for(
        count,
        [&](std::size_t i) {
            tallies[i] = tally_leaf<Channels>(grid.leaves[first + i], values + i * kLeafVoxels * Channels);
        },
        kLeavesPerTask);
    return tallies;
}

template <int Channels, class T>
std::vector<Tally> tally_tiles(const RawGrid<T>& grid) {
    std::vector<Tally> tallies;
    tallies.reserve(grid.tiles.size());
    for (const RawTile<T>& tile : grid.tiles)
        tallies.push_back(tally_tile<Channels>(tile));
    return tallies;
}

inline GridCensus census_from(const Tally& total, std::uint64_t tiles) {
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

}  // namespace brisance
