#include "volume/fog_box.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace brisance {

namespace {

constexpr int kBlockVoxels = BlockGrid::kBlock * BlockGrid::kBlock * BlockGrid::kBlock;
constexpr double kVoxelsAlong = 32.0;  // the longest side, where no voxel is given

void fill_block(const ivec3& block, const ivec3& last, BlockGrid& grid) {
    grid.block_origin.push_back(block * BlockGrid::kBlock);
    for (int n = 0; n < kBlockVoxels; ++n) {
        const ivec3 node = block * BlockGrid::kBlock + ivec3(n >> 6, n >> 3 & 7, n & 7);
        grid.values.push_back(glm::all(glm::lessThanEqual(node, last)) ? 1.0f : 0.0f);
    }
}

}  // namespace

BlockGrid fog_grid(const FogBox& box, std::uint64_t memory_limit_bytes, const std::string& where) {
    const dvec3 size = box.high - box.low;
    const double wish = box.voxel_metres > 0.0 ? box.voxel_metres : std::max({size.x, size.y, size.z}) / kVoxelsAlong;
    const dvec3 nodes = glm::max(glm::round(size / wish), dvec3(1.0));  // spacings along each side
    const dvec3 blocks = glm::floor(nodes / double(BlockGrid::kBlock)) + 1.0;
    const double bytes = blocks.x * blocks.y * blocks.z * kBlockVoxels * sizeof(float);
    if (!(bytes <= double(memory_limit_bytes)))
        throw Error(ExitCode::Temporary, fmt::format("{}: a box of {:.3g} GiB of voxels: raise voxel_metres", where,
                                                     bytes / double(1 << 30)));
    BlockGrid grid;
    grid.info.name = "density";
    grid.info.usable = true;
    const dvec3 spacing = size / nodes;
    grid.info.world_from_index =
        dmat4({spacing.x, 0, 0, 0}, {0, spacing.y, 0, 0}, {0, 0, spacing.z, 0}, glm::dvec4(box.low, 1.0));
    grid.info.active_max = ivec3(nodes);
    for (int x = 0; x < int(blocks.x); ++x)
        for (int y = 0; y < int(blocks.y); ++y)
            for (int z = 0; z < int(blocks.z); ++z)
                fill_block({x, y, z}, ivec3(nodes), grid);
    return grid;
}

}  // namespace brisance
