#include "retiming/centred_velocity.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "retiming/common_lattice.h"

namespace brisance {
namespace {

constexpr double kOutlier = 4.0;  // times the 99th percentile; turbulent fire reaches 2 to 3

BlockGrid joined(const VelocityGrids& grids) {
    if (grids.size() == 1)
        return grids.front();
    const dmat4& transform = grids.front().info.world_from_index;
    std::vector<BlockGrid> parts;
    std::vector<ivec3> bricks;
    for (const BlockGrid& grid : grids) {
        parts.push_back(on_lattice(grid, transform));
        for (const ivec3& origin : parts.back().block_origin)
            bricks.push_back(origin >> 3);
    }
    const BrickLattice lattice(std::move(bricks));
    BlockGrid out;
    out.info = parts.front().info;
    out.channels = 3;
    out.values.resize(lattice.node_count() * 3);
    for (std::size_t c = 0; c < parts.size(); ++c) {
        const std::vector<float> values = values_on(lattice, &parts[c], 1);
        for (std::size_t i = 0; i < values.size(); ++i)
            out.values[3 * i + c] = values[i];
    }
    for (std::size_t b = 0; b < lattice.brick_count(); ++b)
        out.block_origin.push_back(lattice.first_node(b));
    return out;
}

bool is_zero(const float* v) {
    return v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f;
}

// The mean of both faces along each axis; the near one alone where nothing is stored beyond it.
std::vector<float> centres_of_faces(const BlockGrid& grid) {
    const BrickLattice lattice = lattice_of(grid);
    std::vector<float> centres = grid.values;
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        for (std::size_t i = b * kNodesPerBrick; i < (b + 1) * kNodesPerBrick; ++i) {
            if (is_zero(&grid.values[3 * i]))
                continue;
            for (int axis = 0; axis < 3; ++axis) {
                ivec3 next = lattice.node(i);
                ++next[axis];
                const std::int64_t beyond = lattice.find_node(next);
                if (beyond >= 0 && !is_zero(&grid.values[3 * beyond]))
                    centres[3 * i + axis] = 0.5f * (grid.values[3 * i + axis] + grid.values[3 * beyond + axis]);
            }
        }
    });
    return centres;
}

float length_of(const float* v) {
    return std::hypot(v[0], v[1], v[2]);
}

void clamp_outliers(CentredVelocity& velocity) {
    std::vector<float>& values = velocity.grid.values;
    std::vector<float> lengths;
    for (std::size_t i = 0; i < values.size(); i += 3)
        if (const float length = length_of(&values[i]); length > 0.0f)
            lengths.push_back(length);
    if (lengths.empty())
        return;
    velocity.largest = *std::max_element(lengths.begin(), lengths.end());
    const auto at = lengths.begin() + static_cast<std::ptrdiff_t>(0.99 * double(lengths.size() - 1));
    std::nth_element(lengths.begin(), at, lengths.end());
    velocity.typical = *at;
    velocity.limit = kOutlier * velocity.typical;
    for (std::size_t i = 0; i < values.size(); i += 3) {
        const double length = length_of(&values[i]);
        if (length <= velocity.limit)
            continue;
        ++velocity.outliers;
        for (int c = 0; c < 3; ++c)
            values[i + c] = static_cast<float>(values[i + c] / length * velocity.limit);
    }
}

}  // namespace

CentredVelocity centred_velocity(const VelocityGrids& grids) {
    CentredVelocity out;
    if (grids.empty())
        return out;
    out.grid = joined(grids);
    if (out.grid.info.grid_class == "staggered" && grids.size() == 1)
        out.grid.values = centres_of_faces(out.grid);
    clamp_outliers(out);
    return out;
}

dmat3 voxels_per_frame(const VelocitySettings& settings, const dmat4& world_from_velocity,
                       const dmat4& world_from_target) {
    const bool seconds = settings.unit == VelocityUnit::Second || settings.unit == VelocityUnit::VoxelSecond;
    const bool voxels = settings.unit == VelocityUnit::VoxelSecond || settings.unit == VelocityUnit::VoxelFrame;
    const dmat3 metres = voxels ? dmat3(world_from_velocity) : dmat3(1.0);
    const double factor = settings.scale / (seconds ? settings.frames_per_second : 1.0);
    return factor * glm::inverse(dmat3(world_from_target)) * metres;
}

}  // namespace brisance
