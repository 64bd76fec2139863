// A sparse lattice of nodes, stored in bricks of 8^3.
//
// Nodes are integer points of index space. A brick with coordinate b owns the nodes 8b .. 8b + 7 on each axis; inside
// it x is the slowest and z the fastest index. Values of a node field lie in one array, brick after brick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace brisance {

class BrickLattice {
public:
    static constexpr int kSize = 8;
    static constexpr int kNodes = kSize * kSize * kSize;

    BrickLattice() = default;

    // From brick coordinates in any order, repeats allowed. Throws Error BadData when the bricks' bounding box is so
    // large that a directory over it would not fit in memory.
    explicit BrickLattice(std::vector<ivec3> bricks);

    std::size_t brick_count() const { return bricks_.size(); }
    std::size_t node_count() const { return bricks_.size() * kNodes; }
    bool empty() const { return bricks_.empty(); }
    const ivec3& brick(std::size_t b) const { return bricks_[b]; }
    ivec3 first_node(std::size_t b) const { return bricks_[b] * kSize; }
    // Where a field's array has this index: the inverse of find_node().
    ivec3 node(std::size_t i) const { return first_node(i / kNodes) + node_in_brick(static_cast<int>(i % kNodes)); }
    ivec3 min_brick() const { return min_; }
    ivec3 brick_extent() const { return extent_; }  // bounding box, in bricks

    // Position of a brick in the arrays, or -1.
    int find(const ivec3& brick) const {
        const ivec3 r = brick - min_;
        if (r.x < 0 || r.y < 0 || r.z < 0 || r.x >= extent_.x || r.y >= extent_.y || r.z >= extent_.z)
            return -1;
        return directory_[(static_cast<std::size_t>(r.x) * extent_.y + r.y) * extent_.z + r.z];
    }

    // Index of a node in a field's array, or -1.
    std::int64_t find_node(const ivec3& node) const {
        const int b = find(node >> 3);
        return b < 0 ? -1 : static_cast<std::int64_t>(b) * kNodes + offset_in_brick(node);
    }

    static int offset_in_brick(const ivec3& node) { return ((node.x & 7) << 6) | ((node.y & 7) << 3) | (node.z & 7); }
    static ivec3 node_in_brick(int offset) { return {offset >> 6, (offset >> 3) & 7, offset & 7}; }

    std::uint64_t bytes() const { return bricks_.size() * sizeof(ivec3) + directory_.size() * sizeof(std::int32_t); }

private:
    std::vector<ivec3> bricks_;  // sorted by (x, y, z)
    ivec3 min_{0};
    ivec3 extent_{0};
    std::vector<std::int32_t> directory_;
};

// Copies the nodes [low, low + size) of a field with `channels` interleaved values into `out` (planar: one plane of
// size.x * size.y * size.z values per channel, z fastest). Nodes outside every brick read 0.
void copy_box(const BrickLattice& lattice, std::span<const float> field, int channels, const ivec3& low,
              const ivec3& size, std::span<float> out);

// The lattice of every second node: its bricks are those whose vertices lie within one coarse spacing of a fine node.
BrickLattice coarse_lattice(const BrickLattice& fine);

// The coordinates of all bricks that hold a node at most `radius` (at most 8) nodes away, per axis, from one of
// `marked`.
std::vector<ivec3> bricks_around(const BrickLattice& lattice, const std::vector<std::uint8_t>& marked, int radius);

}  // namespace brisance
