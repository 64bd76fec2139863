#include "medium/lattice/homogeneous_bricks.h"

namespace brisance {

namespace {

constexpr int kRim = 2;  // bricks: the outermost are no neighbours of the medium's

bool thin_around(const BrickLattice& lattice, const std::vector<std::uint8_t>& thin, const ivec3& brick) {
    for (int k = 0; k < 27; ++k) {
        const int b = lattice.find(brick + ivec3(k / 9, k / 3 % 3, k % 3) - 1);
        if (b >= 0 && !thin[std::size_t(b)])
            return false;
    }
    return true;
}

}  // namespace

HomogeneousBricks::HomogeneousBricks(const BrickLattice& lattice, const ivec3& reference_node,
                                     const std::vector<std::uint8_t>& thin)
    : min_brick_(lattice.min_brick() - kRim), extent_(lattice.brick_extent() + 2 * kRim) {
    even_.reserve(std::size_t(extent_.x) * extent_.y * extent_.z);
    for (int x = 0; x < extent_.x; ++x)
        for (int y = 0; y < extent_.y; ++y)
            for (int z = 0; z < extent_.z; ++z)
                even_.push_back(thin_around(lattice, thin, min_brick_ + ivec3(x, y, z)));
    min_brick_ -= reference_node >> 3;
}

bool HomogeneousBricks::at(const ivec3& brick) const {
    const ivec3 r = glm::clamp(brick - min_brick_, ivec3(0), extent_ - 1);
    return even_[(std::size_t(r.x) * extent_.y + r.y) * extent_.z + r.z] != 0;
}

HomogeneousBricks::View HomogeneousBricks::view() const {
    return {even_.data(), {min_brick_.x, min_brick_.y, min_brick_.z}, {extent_.x, extent_.y, extent_.z}};
}

}  // namespace brisance
