// One .vdb file as plain data. No OpenVDB type crosses this header: read_vdb.cpp is the wall, and runs in
// a process of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"

namespace brisance {

// Counts over a grid's active voxels (tiles counted as the voxels they stand for).
struct GridCensus {
    std::uint64_t active_voxels = 0;
    std::uint64_t active_tiles = 0;
    std::uint64_t nan_voxels = 0;       // NaN or infinite
    std::uint64_t negative_voxels = 0;  // below zero in any channel
    double minimum = 0.0;               // over finite active values; of the length for vectors
    double maximum = 0.0;
    double mean = 0.0;
    std::vector<std::uint64_t> histogram;  // equal bins over [minimum, maximum]; filled by inspection only
};

// A file's metadata of one grid, readable without its voxels.
struct GridInfo {
    std::string name;          // may be empty
    int index = 0;             // among the grids of this name, in file order
    std::string value_type;    // "float", "half", "vec3s", "points", ...
    std::string grid_class;    // "fog volume", "level set", "staggered", "unknown"
    bool usable = false;       // numbers we can render: float, double, half, int, vec3 of a fog or unknown class
    std::string why_unusable;  // one line that ends with what would fix it
    dmat4 world_from_index{1.0};
    bool affine = true;  // false: frustum
    ivec3 active_min{0};
    ivec3 active_max{-1};  // inclusive; active_max < active_min: no active voxel
    std::string creator;   // file-level metadata where present
    double voxel_volume() const;
};

// A grid's voxels as 8^3 blocks aligned to multiples of 8, sorted by (x, y, z) of the block origin.
// Inside a block x is the slowest and z the fastest index, channels interleaved innermost. Inactive voxels hold 0.
// Active tiles are expanded and blocks that hold nothing but 0 left out. Non-finite values have become 0 and are
// counted in `census`. Negative values are counted and kept; readers must clamp them.
struct BlockGrid {
    static constexpr int kBlock = 8;
    GridInfo info;
    GridCensus census;
    int channels = 1;  // 1 or 3
    std::vector<ivec3> block_origin;
    std::vector<float> values;  // block_origin.size() * 512 * channels
    bool empty() const { return block_origin.empty(); }
};

// Reads one file in a child process, which OpenVDB cannot leave: a damaged file makes it overwrite memory, run for ever
// or take all memory. The child may take 256 MiB and 100 bytes for each byte of the file, 5 s of processor time and 1 s
// for each MiB; beyond that, and where it crashes, the file is damaged. A grid that cannot be read may have changed the
// memory of its child: what is asked next is asked of a new one.
// Throws Error: MissingInput (no such file), BadData (not a VDB, truncated, damaged, a Git LFS pointer, no grid...),
// Temporary (no process, or no memory, for the child).
class VdbReader {
public:
    explicit VdbReader(const std::filesystem::path& file);
    ~VdbReader();

    // Without voxels, in the order of the file; as long as the reader lives.
    const std::vector<GridInfo>& grids() const { return grids_; }

    // One grid by name and index. Throws Error BadData when it is absent (naming those that are there), unusable, has a
    // singular or frustum transform, an absurd bounding box, or would need more than `memory_limit_bytes`.
    BlockGrid read(const std::string& name, int index, std::uint64_t memory_limit_bytes);

    // A census with a histogram for `inspect`, made without expanding tiles.
    GridCensus census(const std::string& name, int index, int bins);

private:
    class Session;
    void start_again_if_spent();

    std::filesystem::path file_;
    std::unique_ptr<Session> session_;
    std::vector<GridInfo> grids_;  // apart from the session, which ends with its child
};

// The same for a single question.
std::vector<GridInfo> list_grids(const std::filesystem::path& file);
BlockGrid read_grid(const std::filesystem::path& file, const std::string& name, int index,
                    std::uint64_t memory_limit_bytes);
GridCensus census_of_grid(const std::filesystem::path& file, const std::string& name, int index, int bins);

}  // namespace brisance
