// What runs in the child process: OpenVDB reads a file there, and its voxels stay as they lie in memory.
#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "volume/raw_grid.h"
#include "volume/vdb_file.h"

namespace brisance {

template <class T>
struct LoadedVoxels {
    using Value = T;
    int channels = 1;
    std::vector<RawLeaf> leaves;   // sorted by origin
    std::vector<const T*> values;  // of each leaf
    std::vector<RawTile<T>> tiles;
    std::shared_ptr<const void> owner;  // keeps the values alive
};

using AnyLoadedVoxels =
    std::variant<LoadedVoxels<float>, LoadedVoxels<double>, LoadedVoxels<std::int32_t>, LoadedVoxels<std::int64_t>>;

struct LoadedGrid {
    std::optional<AnyLoadedVoxels> voxels;  // none: points or flags, of which only these are known:
    std::uint64_t active_voxels = 0;
    std::uint64_t active_tiles = 0;
};

// An open file. Its functions throw Error as those of VdbReader do.
class OpenVdb {
public:
    virtual ~OpenVdb() = default;
    virtual std::vector<GridInfo> grids() = 0;

    // Number k of grids(). Refuses one that says that it needs more than `memory_limit_bytes`.
    virtual LoadedGrid load(std::size_t k, std::uint64_t memory_limit_bytes) = 0;
};

std::unique_ptr<OpenVdb> open_vdb(const std::filesystem::path& file);

// Readies OpenVDB in this process, so that no child has to.
void initialize_openvdb();

}  // namespace brisance
