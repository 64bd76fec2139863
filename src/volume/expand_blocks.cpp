// Leaves come a few at a time and in the order of the blocks: each is counted, and copied when it holds anything.
// Partial results are kept per leaf and added in that order, so that no thread can change a sum.
#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "core/error.h"
#include "core/parallel.h"
#include "volume/raw_grid.h"
#include "volume/voxel_tally.h"

namespace brisance {
namespace {

constexpr int kBlock = BlockGrid::kBlock;
constexpr int kFarthest = 1 << 30;         // index coordinates beyond this overflow 32-bit differences
constexpr std::int64_t kWidest = 1 << 20;  // no simulation is a million voxels wide: a stray voxel is

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

template <int Channels, class T>
void copy_voxel(const T* stored, float* to) {
    const Voxel<Channels, T> voxel(stored);
    if (voxel.finite)
        std::copy(voxel.value, voxel.value + Channels, to);
}

// Takes leaves in their order and adds blocks where they hold anything, with those of tiles in between.
template <int Channels, class T>
class Expansion {
public:
    Expansion(const RawGrid<T>& grid, std::uint64_t limit, const std::string& where)
        : grid_(grid), limit_(limit), where_(where), tiles_(tally_tiles<Channels>(grid)) {
        count_tile_blocks();
        if (!fits(0))
            return;
        list_tile_blocks();
        const std::uint64_t most = std::min<std::uint64_t>(grid.leaves.size() + from_tiles_, limit / kBlockBytes);
        blocks_.values.reserve(most * kBlockValues);  // takes memory only where it is filled
    }

    void add(std::size_t first, std::size_t count, const T* values) {
        const std::vector<Tally> tallies = tally_leaves<Channels>(grid_, first, count, values);
        for (const Tally& tally : tallies) {
            total_.add(tally);
            leaf_blocks_ += tally.all_zero ? 0 : 1;
        }
        if (!fits(leaf_blocks_))
            blocks_ = {};  // goes on to count, for the message
        else
            copy(first, tallies, values);
    }

    BlockGrid finish(const GridInfo& info) {
        for (const Tally& tally : tiles_)
            total_.add(tally);
        check_bounds(total_, where_);
        check_memory();
        add_tile_blocks(tile_blocks_.size());
        blocks_.info = info;
        const bool none = total_.active == 0;
        blocks_.info.active_min = none ? ivec3(0) : total_.low;
        blocks_.info.active_max = none ? ivec3(-1) : total_.high;
        blocks_.census = census_from(total_, grid_.tiles.size());
        blocks_.channels = Channels;
        return std::move(blocks_);
    }

private:
    static constexpr std::size_t kBlockValues = kLeafVoxels * Channels;
    static constexpr std::size_t kBlockBytes = kBlockValues * sizeof(float) + sizeof(ivec3);

    struct TileBlock {
        ivec3 origin;
        const RawTile<T>* tile;
    };

    void count_tile_blocks() {
        for (std::size_t i = 0; i < tiles_.size(); ++i) {
            const auto along = static_cast<std::uint64_t>(grid_.tiles[i].width / kBlock);
            from_tiles_ += tiles_[i].all_zero ? 0 : along * along * along;
        }
    }

    double bytes(std::uint64_t leaf_blocks) const {
        return static_cast<double>(leaf_blocks + from_tiles_) * static_cast<double>(kBlockBytes);
    }

    bool fits(std::uint64_t leaf_blocks) const { return bytes(leaf_blocks) <= static_cast<double>(limit_); }

    void list_tile_blocks() {
        for (std::size_t i = 0; i < tiles_.size(); ++i) {
            const RawTile<T>& tile = grid_.tiles[i];
            for (int x = 0; x < tile.width && !tiles_[i].all_zero; x += kBlock)
                for (int y = 0; y < tile.width; y += kBlock)
                    for (int z = 0; z < tile.width; z += kBlock)
                        tile_blocks_.push_back({tile.origin + ivec3(x, y, z), &tile});
        }
        std::sort(tile_blocks_.begin(), tile_blocks_.end(),
                  [](const TileBlock& a, const TileBlock& b) { return comes_before(a.origin, b.origin); });
    }

    // Adds the blocks of tiles up to number `end`.
    void add_tile_blocks(std::size_t end) {
        for (; next_tile_block_ < end; ++next_tile_block_) {
            const TileBlock& block = tile_blocks_[next_tile_block_];
            blocks_.block_origin.push_back(block.origin);
            blocks_.values.resize(blocks_.values.size() + kBlockValues);
            float* to = &blocks_.values[blocks_.values.size() - kBlockValues];
            for (std::size_t i = 0; i < kLeafVoxels; ++i, to += Channels)
                copy_voxel<Channels>(block.tile->value, to);
        }
    }

    void copy(std::size_t first, const std::vector<Tally>& tallies, const T* values) {
        std::vector<std::size_t> sources, places;
        for (std::size_t i = 0; i < tallies.size(); ++i) {
            if (tallies[i].all_zero)
                continue;
            const ivec3& origin = grid_.leaves[first + i].origin;
            std::size_t end = next_tile_block_;
            while (end < tile_blocks_.size() && comes_before(tile_blocks_[end].origin, origin))
                ++end;
            add_tile_blocks(end);
            sources.push_back(i);
            places.push_back(blocks_.values.size());
            blocks_.block_origin.push_back(origin);
            blocks_.values.resize(blocks_.values.size() + kBlockValues);
        }
        parallel_for(
            sources.size(),
            [&](std::size_t n) {
                const T* const from = values + sources[n] * kBlockValues;
                float* const to = &blocks_.values[places[n]];
                for_active(grid_.leaves[first + sources[n]].active,
                           [&](std::size_t i) { copy_voxel<Channels>(from + i * Channels, to + i * Channels); });
            },
            kLeavesPerTask);
    }

    void check_memory() const {
        if (fits(leaf_blocks_))
            return;
        throw Error(ExitCode::BadData,
                    fmt::format("{}: needs {:.1f} MiB ({} blocks of 8^3 voxels and {} more where {} constant tiles are "
                                "expanded), the limit is {:.1f} MiB; {}, or raise the limit",
                                where_, bytes(leaf_blocks_) / 1048576.0, leaf_blocks_, from_tiles_, grid_.tiles.size(),
                                static_cast<double>(limit_) / 1048576.0,
                                from_tiles_ > leaf_blocks_ ? "clip or deactivate the constant regions where it was made"
                                                           : "write the grid with larger voxels"));
    }

    const RawGrid<T>& grid_;
    std::uint64_t limit_;
    const std::string& where_;
    std::vector<Tally> tiles_;
    std::vector<TileBlock> tile_blocks_;  // in the order of blocks
    std::size_t next_tile_block_ = 0;
    Tally total_;
    std::uint64_t leaf_blocks_ = 0, from_tiles_ = 0;  // that hold anything
    BlockGrid blocks_;
};

// What the masks alone tell: strays are found before any value is copied.
void check_leaf_bounds(const std::vector<RawLeaf>& leaves, const std::string& where) {
    Tally total;
    for (const RawLeaf& leaf : leaves) {
        Tally tally;
        tally_bounds(leaf.origin, leaf.active, tally);
        total.add(tally);
    }
    check_bounds(total, where);
}

template <int Channels, class T>
BlockGrid expand(const RawGrid<T>& grid, const GridInfo& info, std::uint64_t limit, const std::string& where) {
    check_leaf_bounds(grid.leaves, where);
    Expansion<Channels, T> expansion(grid, limit, where);
    grid.visit_leaves(
        [&](std::size_t first, std::size_t count, const T* values) { expansion.add(first, count, values); });
    return expansion.finish(info);
}

}  // namespace

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
