// Trilinear interpolation from a lattice of every second node to the nodes of the finer one, brick by brick.
#pragma once

#include <span>
#include <vector>

#include "core/parallel.h"
#include "medium/lattice/brick_masks.h"

namespace brisance {

// Calls take(node, values) with the interpolated values of all planes at each marked node of `fine`, from several
// threads: a brick in one of them, and in order. `planes`: per node of `coarse`.
template <class Take>
void for_each_between_parents(const BrickLattice& coarse, const std::vector<std::span<const float>>& planes,
                              const BrickLattice& fine, const std::vector<std::uint8_t>& marked, const Take& take) {
    constexpr int kParents = BrickLattice::kSize / 2 + 1;  // around a brick: from its first node's to beyond its last's
    constexpr int kBox = kParents * kParents * kParents;
    const auto between = [](const float* box, const ivec3& p) {
        const ivec3 low = p >> 1, high = (p + 1) >> 1;
        const auto along_z = [&](int x, int y) {
            const float* const row = box + (x * kParents + y) * kParents;
            return 0.5f * (row[low.z] + row[high.z]);
        };
        const auto along_y = [&](int x) { return 0.5f * (along_z(x, low.y) + along_z(x, high.y)); };
        return 0.5f * (along_y(low.x) + along_y(high.x));
    };
    parallel_for(
        fine.brick_count(),
        [&](std::size_t b) {
            if (!any_in_brick(marked, b))
                return;
            std::vector<float> boxes(planes.size() * kBox), values(planes.size());
            for (std::size_t c = 0; c < planes.size(); ++c)
                copy_box(coarse, planes[c], 1, fine.first_node(b) >> 1, ivec3(kParents),
                         std::span(boxes).subspan(c * kBox, kBox));
            for (int k = 0; k < BrickLattice::kNodes; ++k) {
                const std::size_t node = b * BrickLattice::kNodes + k;
                if (!marked[node])
                    continue;
                for (std::size_t c = 0; c < planes.size(); ++c)
                    values[c] = between(&boxes[c * kBox], BrickLattice::node_in_brick(k));
                take(node, std::span<float>(values));
            }
        },
        16);
}

}  // namespace brisance
