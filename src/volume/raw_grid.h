// A grid's voxels as they come from the file, and functions that count and copy them. No OpenVDB type appears here.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "core/vec.h"
#include "volume/vdb_file.h"

namespace brisance {

// 8^3 voxels with x slowest and z fastest.
struct RawLeaf {
    ivec3 origin;             // multiples of 8
    std::uint64_t active[8];  // bit (y * 8 + z) of word x
};

// A cube of equal active voxels.
template <class T>
struct RawTile {
    ivec3 origin;
    int width;  // voxels along each side, a multiple of 8
    T value[3];
};

// The values of `count` leaves from `first` on: 512 voxels each, channels interleaved.
template <class T>
using VisitLeaves = std::function<void(std::size_t first, std::size_t count, const T* values)>;

template <class T>
struct RawGrid {
    using Value = T;
    int channels = 1;
    std::vector<RawLeaf> leaves;    // sorted by origin: x, then y, then z
    std::vector<RawTile<T>> tiles;  // all outside of the leaves
    // Visits all leaves, in their order, a few at a time: their values are gone after each visit.
    std::function<void(const VisitLeaves<T>& visit)> visit_leaves;
};

using AnyRawGrid = std::variant<RawGrid<float>, RawGrid<double>, RawGrid<std::int32_t>, RawGrid<std::int64_t>>;

bool comes_before(const ivec3& a, const ivec3& b);  // in the order of leaves and blocks

// Counts and, with bins > 0, a histogram. Tiles are not expanded.
GridCensus count_voxels(const AnyRawGrid& grid, int bins);

// Blocks as BlockGrid promises them; fills census, channels, and the exact active bounds of `info`.
// Throws Error BadData when the bounds are absurd or the blocks need more than `memory_limit_bytes`, Temporary when
// memory runs out. `where` begins the message: file and grid.
BlockGrid expand_blocks(const AnyRawGrid& grid, const GridInfo& info, std::uint64_t memory_limit_bytes,
                        const std::string& where);

}  // namespace brisance
