#include "radiance_cascades/cascade.h"

#include <algorithm>
#include <cstring>

namespace brisance {

namespace {

constexpr int kSize = BrickLattice::kSize;
constexpr std::size_t kGroup = 16;  // probes that the kernel takes together

}  // namespace

std::vector<OccupiedNodes> occupied_nodes(const BrickLattice& lattice, const std::vector<float>& extinction) {
    std::vector<OccupiedNodes> bricks(lattice.brick_count());
    for (std::size_t i = 0; i < extinction.size(); ++i)
        if (extinction[i] > 0.0f) {
            OccupiedNodes& o = bricks[i / BrickLattice::kNodes];
            const ivec3 node = BrickLattice::node_in_brick(static_cast<int>(i % BrickLattice::kNodes));
            o.low = glm::min(o.low, node);
            o.high = glm::max(o.high, node);
        }
    return bricks;
}

void FieldBlock::fill(const CascadeField& field, const std::vector<OccupiedNodes>& occupied, const ivec3& low,
                      const ivec3& high) {
    low_ = low;
    size_ = high - low + 1;
    occupied_low_ = vec3(1e30f);
    occupied_high_ = vec3(-1e30f);
    values_.assign(std::size_t(size_.x) * size_.y * size_.z * 4, 0.0f);
    const ivec3 first = low >> 3, last = high >> 3;
    for (int bx = first.x; bx <= last.x; ++bx)
        for (int by = first.y; by <= last.y; ++by)
            for (int bz = first.z; bz <= last.z; ++bz) {
                const int b = field.lattice->find({bx, by, bz});
                if (b < 0 || occupied[b].empty())
                    continue;
                const ivec3 origin = ivec3(bx, by, bz) * kSize;
                const ivec3 from = glm::max(low, origin + occupied[b].low),
                            to = glm::min(high, origin + occupied[b].high);
                if (from.x > to.x || from.y > to.y || from.z > to.z)
                    continue;
                occupied_low_ = glm::min(occupied_low_, vec3(from));
                occupied_high_ = glm::max(occupied_high_, vec3(to));
                const float* source = field.nodes->data() + std::size_t(b) * BrickLattice::kNodes * 4;
                for (int x = from.x; x <= to.x; ++x)
                    for (int y = from.y; y <= to.y; ++y)
                        std::memcpy(values_.data() + std::size_t(index({x, y, from.z})) * 4,
                                    source + std::size_t(BrickLattice::offset_in_brick({x, y, from.z})) * 4,
                                    std::size_t(to.z - from.z + 1) * 4 * sizeof(float));
            }
}

bool FieldBlock::may_hold(const vec3& low, const vec3& high) const {
    for (int a = 0; a < 3; ++a)
        if (high[a] <= occupied_low_[a] - 1.0f || low[a] >= occupied_high_[a] + 1.0f)
            return false;
    return true;
}

CascadeProbes::CascadeProbes(BrickLattice nodes, const std::vector<std::uint8_t>& needed)
    : lattice(std::move(nodes)), number(needed.size(), -1) {
    for (std::size_t i = 0; i < needed.size(); ++i)
        if (needed[i])
            number[i] = static_cast<std::int32_t>(count++);
}

int corner_count(int axes) {
    return 1 << ((axes >> 2 & 1) + (axes >> 1 & 1) + (axes & 1));
}

ivec3 corner_offset(int axes, int corner) {
    ivec3 offset(0);
    for (int a = 0; a < 3; ++a)
        if (axes >> (2 - a) & 1) {
            offset[a] = corner & 1 ? 1 : -1;
            corner >>= 1;
        }
    return offset;
}

std::vector<ProbeClass> probe_classes(const CascadeProbes& probes, std::size_t brick, const CascadeProbes* next) {
    std::vector<ProbeClass> classes(8);
    const ivec3 origin = probes.lattice.first_node(brick);
    for (int n = 0; n < BrickLattice::kNodes; ++n) {
        const ivec3 node = BrickLattice::node_in_brick(n);
        if (probes.number[brick * BrickLattice::kNodes + n] >= 0)
            classes[(node.x & 1) << 2 | (node.y & 1) << 1 | (node.z & 1)].nodes.push_back(n);
    }
    for (int axes = 0; axes < 8; ++axes) {
        ProbeClass& c = classes[axes];
        c.axes = axes;
        c.count = static_cast<int>(c.nodes.size());
        if (c.count == 0)
            continue;
        c.nodes.resize((c.nodes.size() + kGroup - 1) / kGroup * kGroup, c.nodes.back());
        for (int k = 0; next && k < corner_count(axes); ++k) {
            std::vector<int>& following = c.following.emplace_back();
            for (const int n : c.nodes)
                following.push_back(next->at((origin + BrickLattice::node_in_brick(n) + corner_offset(axes, k)) >> 1));
        }
    }
    std::erase_if(classes, [](const ProbeClass& c) { return c.count == 0; });
    return classes;
}

}  // namespace brisance
