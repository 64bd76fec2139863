#include "medium/lattice/source_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace brisance {

namespace {

// Of a medium while it is built: extinction, radiance and albedo, twice.
constexpr double kBytesPerNode = 56.0;
constexpr double kMostBytes = double(std::uint64_t{12} << 30);

}  // namespace

dmat4 shifted(const BlockGrid& grid, bool half_voxel_shift) {
    dmat4 m = grid.info.world_from_index;
    if (half_voxel_shift)
        m[3] = m * glm::dvec4(0.5, 0.5, 0.5, 1.0);
    return m;
}

SourceGrid source_grid(const BlockGrid& grid, bool half_voxel_shift, const dmat4& world_from_target) {
    SourceGrid s{&grid, {}, glm::inverse(shifted(grid, half_voxel_shift)) * world_from_target, {}};
    std::vector<ivec3> bricks;
    for (const ivec3& o : grid.block_origin)
        bricks.push_back(o >> 3);
    s.lattice = BrickLattice(std::move(bricks));
    // A whole shift, judged where the voxels are: at the corners of the grid's bricks.
    const dmat4 target_from_index = glm::inverse(s.index_from_target);
    const ivec3 first = s.lattice.min_brick() * BrickLattice::kSize;
    const dvec3 whole = glm::round(dvec3(first) - dvec3(target_from_index * glm::dvec4(dvec3(first), 1.0)));
    double deviation = 0.0;
    for (int k = 0; k < 8; ++k) {
        const dvec3 corner(first +
                           s.lattice.brick_extent() * BrickLattice::kSize * ivec3(k & 1, k >> 1 & 1, k >> 2 & 1));
        const dvec3 target(target_from_index * glm::dvec4(corner, 1.0));
        deviation = std::max(deviation, glm::length(corner - target - whole));
    }
    if (deviation < 1e-3)
        s.shift = ivec3(whole);
    return s;
}

namespace {

float node_value(const SourceGrid& s, const ivec3& node, int channel) {
    const std::int64_t i = s.lattice.find_node(node);
    return i < 0 ? 0.0f : s.grid->values[i * s.grid->channels + channel];
}

float interpolated(const SourceGrid& s, const ivec3& target_node, int channel) {
    const dvec3 p = dvec3(s.index_from_target * glm::dvec4(dvec3(target_node), 1.0));
    const dvec3 base = glm::floor(p);
    const dvec3 f = p - base;
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
        const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
        const double w = (d.x ? f.x : 1 - f.x) * (d.y ? f.y : 1 - f.y) * (d.z ? f.z : 1 - f.z);
        if (w > 0.0)
            sum += w * node_value(s, ivec3(base) + d, channel);
    }
    return static_cast<float>(sum);
}

// A coarse grid on a fine lattice: `finer` target nodes for each of its own.
void refuse_too_fine(const SourceGrid& s, double finer) {
    const double bytes = double(s.lattice.node_count()) * finer * kBytesPerNode;
    if (finer > 1.5 && bytes > kMostBytes)
        throw Error(
            ExitCode::Temporary,
            fmt::format("grid '{}' has voxels {:.3g} times the size of the finest volume's and would need {:.0f} "
                        "GiB on its lattice: bring the volumes to voxels of similar size",
                        s.grid->info.name, std::cbrt(finer), bytes / double(1 << 30)));
}

}  // namespace

float read(const SourceGrid& s, const ivec3& target_node, int channel) {
    return s.shift ? node_value(s, target_node + *s.shift, channel) : interpolated(s, target_node, channel);
}

void add_bricks(const SourceGrid& s, std::vector<ivec3>& bricks) {
    const dmat4 target_from_index = glm::inverse(s.index_from_target);
    refuse_too_fine(s, std::abs(glm::determinant(dmat3(target_from_index))));
    for (std::size_t b = 0; b < s.lattice.brick_count(); ++b) {
        dvec3 low(1e300), high(-1e300);
        for (int k = 0; k < 8; ++k) {
            const dvec3 corner = dvec3(s.lattice.first_node(b)) + dvec3(k & 1 ? 8 : -1, k & 2 ? 8 : -1, k & 4 ? 8 : -1);
            const dvec3 p(target_from_index * glm::dvec4(corner, 1.0));
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const ivec3 first = ivec3(glm::floor(low + 1e-6)) >> 3;
        const ivec3 last = ivec3(glm::ceil(high - 1e-6)) >> 3;
        for (int x = first.x; x <= last.x; ++x)
            for (int y = first.y; y <= last.y; ++y)
                for (int z = first.z; z <= last.z; ++z)
                    bricks.emplace_back(x, y, z);
    }
}

}  // namespace brisance
