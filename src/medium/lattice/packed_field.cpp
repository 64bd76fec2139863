#include "medium/lattice/packed_field.h"

#include <Imath/half.h>

#include <algorithm>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr float kStoredMaximum = 60000.0f;  // of a half float: leaves nine decades before values turn subnormal

constexpr int kSide = BrickLattice::kSize + 1;

// Voxels of a brick reach one node into the next brick, so every brick's lower neighbours get voxels too.
BrickLattice bricks_of_voxels(const BrickLattice& lattice) {
    std::vector<ivec3> bricks;
    for (std::size_t b = 0; b < lattice.brick_count(); ++b)
        for (int k = 0; k < 8; ++k)
            bricks.push_back(lattice.brick(b) - ivec3(k >> 2, k >> 1 & 1, k & 1));
    return BrickLattice(std::move(bricks));
}

// The words of one brick of voxels; none where all its nodes are 0.
std::vector<std::uint32_t> packed_brick(const BrickLattice& lattice, const std::vector<float>& nodes,
                                        const ivec3& first_node, float to_stored) {
    std::vector<float> box(kSide * kSide * kSide);
    copy_box(lattice, nodes, 1, first_node, ivec3(kSide), box);
    if (std::all_of(box.begin(), box.end(), [](float v) { return v == 0.0f; }))
        return {};
    std::vector<std::uint32_t> words(PackedExtinction::kWordsPerBrick);
    for (int row = 0; row < kSide * kSide; ++row)
        for (int z = 0; z < BrickLattice::kSize; ++z) {
            const Imath::half low(box[row * kSide + z] * to_stored);
            const Imath::half high(box[row * kSide + z + 1] * to_stored);
            words[row * BrickLattice::kSize + z] = std::uint32_t{low.bits()} | std::uint32_t{high.bits()} << 16;
        }
    return words;
}

}  // namespace

PackedField::PackedField(const BrickLattice& lattice, const std::vector<float>& nodes, const ivec3& reference_node) {
    const ivec3 reference_brick = reference_node >> 3;
    min_brick_ = lattice.min_brick() - reference_brick - 2;
    extent_ = lattice.brick_extent() + 3;
    directory_.assign(std::size_t(extent_.x) * extent_.y * extent_.z, 0);
    const float maximum = nodes.empty() ? 0.0f : *std::max_element(nodes.begin(), nodes.end());
    scale_ = maximum / kStoredMaximum;

    const BrickLattice voxels = bricks_of_voxels(lattice);
    std::vector<std::vector<std::uint32_t>> packed(voxels.brick_count());
    // Extinction too small for its inverse to be a float stops nothing over any distance a float can hold.
    const float to_stored = maximum > 1e-30f ? kStoredMaximum / maximum : 0.0f;
    parallel_for(voxels.brick_count(),
                 [&](std::size_t b) { packed[b] = packed_brick(lattice, nodes, voxels.first_node(b), to_stored); });
    words_.assign(PackedExtinction::kWordsPerBrick, 0);
    for (std::size_t b = 0; b < voxels.brick_count(); ++b) {
        if (packed[b].empty())
            continue;
        const ivec3 r = voxels.brick(b) - reference_brick - min_brick_;
        directory_[(std::size_t(r.x) * extent_.y + r.y) * extent_.z + r.z] = static_cast<std::int32_t>(words_.size());
        words_.insert(words_.end(), packed[b].begin(), packed[b].end());
        packed[b] = {};
    }
}

PackedExtinction PackedField::view() const {
    return {directory_.data(),
            words_.data(),
            {min_brick_.x, min_brick_.y, min_brick_.z},
            {extent_.x, extent_.y, extent_.z},
            scale_};
}

}  // namespace brisance
