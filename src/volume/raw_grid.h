// A grid's voxels as they lie in memory after loading, and functions that count and copy them. No OpenVDB type appears
// here: read_vdb.cpp passes plain pointers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/vec.h"
#include "volume/vdb_file.h"

namespace brisance {

// 512 voxels with x slowest and z fastest, `channels` interleaved values each.
template <class T>
struct RawLeaf {
    ivec3 origin;
    const T* values;
    std::uint64_t active[8];  // bit (y * 8 + z) of word x
};

// A cube of equal active voxels.
template <class T>
struct RawTile {
    ivec3 origin;
    int width;  // voxels along each side, a multiple of 8
    T value[3];
};

template <class T>
struct RawGrid {
    int channels = 1;
    std::vector<RawLeaf<T>> leaves;
    std::vector<RawTile<T>> tiles;
    std::shared_ptr<const void> owner;  // keeps the values alive
};

using AnyRawGrid = std::variant<RawGrid<float>, RawGrid<double>, RawGrid<std::int32_t>, RawGrid<std::int64_t>>;

// Counts and, with bins > 0, a histogram. Tiles are not expanded.
GridCensus count_voxels(const AnyRawGrid& grid, int bins);

// Blocks as BlockGrid promises them; fills census, channels, and the exact active bounds of `info`.
// Throws Error BadData when the bounds are absurd or the blocks need more than `memory_limit_bytes`, Temporary when
// memory runs out. `where` begins the message: file and grid.
BlockGrid expand_blocks(const AnyRawGrid& grid, const GridInfo& info, std::uint64_t memory_limit_bytes,
                        const std::string& where);

}  // namespace brisance
