// One cascade: its probes, the interval of distances that it is responsible for, and the medium that it marches.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "medium/lattice/extinction_pyramid.h"

namespace brisance {

// The four values of march_intervals() at the nodes of a level of the pyramid.
struct CascadeField {
    const BrickLattice* lattice = nullptr;
    const std::vector<float>* nodes = nullptr;
};

// Where a brick of a lattice has extinction: nodes from its first, bounds included; empty where low > high.
struct OccupiedNodes {
    ivec3 low{BrickLattice::kSize}, high{-1};
    bool empty() const { return low.x > high.x; }
};
std::vector<OccupiedNodes> occupied_nodes(const BrickLattice& lattice, const std::vector<float>& extinction);

// Nodes [low, low + size) of a lattice, z fastest, four values each; 0 outside of all bricks.
class FieldBlock {
public:
    void fill(const CascadeField& field, const std::vector<OccupiedNodes>& occupied, const ivec3& low,
              const ivec3& high);

    const float* values() const { return values_.data(); }
    int stride_x() const { return size_.y * size_.z; }
    int stride_y() const { return size_.z; }
    int index(const ivec3& node) const {
        const ivec3 at = node - low_;
        return (at.x * size_.y + at.y) * size_.z + at.z;
    }
    // Whether the box may hold extinction between its nodes.
    bool may_hold(const vec3& low, const vec3& high) const;

private:
    ivec3 low_{0}, size_{0};
    vec3 occupied_low_{0.0f}, occupied_high_{-1.0f};
    std::vector<float> values_;
};

// Probes of a cascade: nodes of a lattice, each with a number. The coordinates of the finest are those of the pyramid's
// nodes; every second one is a probe of the next cascade.
struct CascadeProbes {
    BrickLattice lattice;
    std::vector<std::int32_t> number;  // per node; -1: none is needed there
    std::size_t count = 0;

    CascadeProbes(BrickLattice nodes, const std::vector<std::uint8_t>& needed);
    int at(const ivec3& probe) const {
        const std::int64_t i = lattice.find_node(probe);
        return i < 0 ? -1 : number[i];
    }
};

// Probes of one brick that lie alike among those of the next cascade: odd or even on each axis.
struct ProbeClass {
    int axes = 0;                             // bits 4, 2, 1: odd along x, y, z
    std::vector<int> nodes;                   // in the brick; as many as a kernel needs: the last is repeated
    int count = 0;                            // without repetition
    std::vector<std::vector<int>> following;  // per corner, of each: number of the next cascade's probe
};

// The corners of a class: probes of the next cascade among which its probes lie, each of equal weight.
int corner_count(int axes);
// From a probe to a corner, in probes of its own cascade: 0, 1 or -1 per axis.
ivec3 corner_offset(int axes, int corner);

// `next`: the probes of the next cascade; null for the last.
std::vector<ProbeClass> probe_classes(const CascadeProbes& probes, std::size_t brick, const CascadeProbes* next);

}  // namespace brisance
