#include "retiming/common_lattice.h"

#include <algorithm>

#include "core/parallel.h"
#include "medium/lattice/source_grid.h"

namespace brisance {
namespace {

void take_bounds(BlockGrid& grid) {
    if (grid.empty()) {
        grid.info.active_min = ivec3(0);
        grid.info.active_max = ivec3(-1);
        return;
    }
    grid.info.active_min = grid.info.active_max = grid.block_origin.front();
    for (const ivec3& origin : grid.block_origin) {
        grid.info.active_min = glm::min(grid.info.active_min, origin);
        grid.info.active_max = glm::max(grid.info.active_max, origin + (BlockGrid::kBlock - 1));
    }
}

// Moves what is not zero to a grid of its own.
void take_bricks(const BrickLattice& lattice, const std::vector<float>& values, int channels, BlockGrid& to) {
    const std::size_t per_brick = kNodesPerBrick * static_cast<std::size_t>(channels);
    to.channels = channels;
    for (std::size_t b = 0; b < lattice.brick_count(); ++b) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(b * per_brick);
        const auto last = first + static_cast<std::ptrdiff_t>(per_brick);
        if (std::all_of(first, last, [](float v) { return v == 0.0f; }))
            continue;
        to.block_origin.push_back(lattice.first_node(b));
        to.values.insert(to.values.end(), first, last);
    }
    take_bounds(to);
}

}  // namespace

BlockGrid on_lattice(BlockGrid grid, const dmat4& world_from_index) {
    if (grid.info.world_from_index == world_from_index)
        return grid;
    BlockGrid moved;
    moved.info = grid.info;
    moved.census = grid.census;
    moved.channels = grid.channels;
    moved.info.world_from_index = world_from_index;
    if (!grid.empty()) {
        const SourceGrid source = source_grid(grid, false, world_from_index);
        std::vector<ivec3> bricks;
        add_bricks(source, bricks);
        const BrickLattice lattice(std::move(bricks));
        std::vector<float> values(lattice.node_count() * grid.channels);
        parallel_for(lattice.brick_count(), [&](std::size_t b) {
            for (std::size_t i = b * kNodesPerBrick; i < (b + 1) * kNodesPerBrick; ++i)
                for (int c = 0; c < grid.channels; ++c)
                    values[i * grid.channels + c] = read(source, lattice.node(i), c);
        });
        take_bricks(lattice, values, grid.channels, moved);
    }
    take_bounds(moved);
    return moved;
}

BrickLattice lattice_of(const BlockGrid& grid) {
    std::vector<ivec3> bricks;
    bricks.reserve(grid.block_origin.size());
    for (const ivec3& origin : grid.block_origin)
        bricks.push_back(origin >> 3);
    return BrickLattice(std::move(bricks));
}

std::vector<float> values_on(const BrickLattice& lattice, const BlockGrid* grid, int channels) {
    const std::size_t per_brick = kNodesPerBrick * static_cast<std::size_t>(channels);
    std::vector<float> values(lattice.node_count() * channels, 0.0f);
    for (std::size_t i = 0; grid != nullptr && i < grid->block_origin.size(); ++i) {
        const int b = lattice.find(grid->block_origin[i] >> 3);
        if (b >= 0)
            std::copy_n(&grid->values[i * per_brick], per_brick, &values[static_cast<std::size_t>(b) * per_brick]);
    }
    return values;
}

BlockGrid grid_of(const BrickLattice& lattice, const std::vector<float>& values, const BlockGrid* a,
                  const BlockGrid* b) {
    const BlockGrid& like = a != nullptr ? *a : *b;
    BlockGrid grid;
    grid.info = like.info;
    grid.census = like.census;
    if (a != nullptr && b != nullptr) {
        grid.census.nan_voxels += b->census.nan_voxels;
        grid.census.negative_voxels += b->census.negative_voxels;
        grid.census.maximum = std::max(a->census.maximum, b->census.maximum);
        grid.census.minimum = std::min(a->census.minimum, b->census.minimum);
    }
    take_bricks(lattice, values, like.channels, grid);
    return grid;
}

}  // namespace brisance
