#include "thin_media/smoke_in_brick.h"

#include <array>

namespace brisance {

namespace {

// The box around the nodes of a brick that scatter or absorb light.
BrickPart smoke_in_brick(const Medium& medium, std::size_t brick) {
    constexpr int kSide = BrickLattice::kSize + 1;
    std::array<float, kSide * kSide * kSide> extinction;
    copy_box(medium.lattice, medium.extinction, 1, medium.lattice.first_node(brick), ivec3(kSide), extinction);
    BrickPart box{ivec3(kSide), ivec3(-1)};
    for (int k = 0; k < int(extinction.size()); ++k)
        if (const ivec3 node(k / (kSide * kSide), k / kSide % kSide, k % kSide); extinction[k] > 0.0f) {
            box.low = glm::min(box.low, node);
            box.high = glm::max(box.high, node);
        }
    return box;
}

// Whether a surface comes between two nodes of the box that follow each other along an axis.
bool parts_nodes(const Occluders& surfaces, const Medium& medium, const ivec3& first_node, const BrickPart& box) {
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int i = box.low[u]; i <= box.high[u]; ++i)
            for (int j = box.low[v]; j <= box.high[v]; ++j) {
                ivec3 from = box.low, to = box.high;
                from[u] = to[u] = i;
                from[v] = to[v] = j;
                if (!surfaces.visible(medium.local_of_node(first_node + from), medium.local_of_node(first_node + to)))
                    return true;
            }
    }
    return false;
}

}  // namespace

std::optional<BrickPart> unparted_smoke(const Occluders& surfaces, const Medium& medium, std::size_t brick) {
    const ivec3 first = medium.lattice.first_node(brick);
    const BrickPart whole = smoke_in_brick(medium, brick), inner{whole.low + 1, whole.high - 1};
    for (const BrickPart& part : {whole, inner})
        if (!part.empty() && !parts_nodes(surfaces, medium, first, part))
            return part;
    return std::nullopt;
}

}  // namespace brisance
