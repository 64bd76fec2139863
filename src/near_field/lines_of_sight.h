// Which nodes of a lattice see each other past the surfaces between them, for the near field.
//
// Two nodes see each other if a path of open edges joins them that never turns back along an axis. An edge joins nodes
// side by side. It is open if no surface crosses it. Past one plane this is exact, however the plane lies: between two
// nodes on one side, the path that moves away from the plane first stays there, and no path reaches the other side. At
// the rim of a surface a path may lead around it although the straight line meets it. Between two surfaces less than an
// edge apart, oblique to the axes, there may be no path although the line is free.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "medium/lattice/occluders.h"

namespace brisance {

class LinesOfSight {
public:
    // The nodes of a brick, and as many more all round as separations reach.
    class Stencil {
    public:
        // Keeps no reference.
        explicit Stencil(std::span<const ivec3> separations);

    private:
        friend class LinesOfSight;
        struct Cell {
            std::array<int, 3> predecessor;  // among the cells, a step nearer along each axis; -1: it is no nearer
            std::array<int, 3> edge;         // offset of the node where the edge between both begins
        };
        int offset(const ivec3& o) const { return (o.x * box_.y + o.y) * box_.z + o.z; }

        ivec3 margin_{0}, box_{0};                // nodes
        std::vector<Cell> cells_;                 // the nearest first; the first is the node itself
        std::vector<std::uint32_t> separations_;  // among the cells
    };

    // Keeps references. Node p lies at local_from_index * (p - reference_node), local [m].
    LinesOfSight(const Occluders& occluders, const mat3& local_from_index, const ivec3& reference_node)
        : occluders_(occluders), local_from_index_(local_from_index), reference_node_(reference_node) {}

    // For each row along z of a brick's nodes, and each separation in turn, `seen` gets a byte. Its bit k tells whether
    // the row's node k sees the node at that separation. Returns false and leaves `seen` alone where all edges are
    // open.
    bool look(const Stencil& stencil, const ivec3& first_node, std::vector<std::uint8_t>& seen) const;

private:
    struct Edges;
    // Closes the edges of some nodes of the box, from `first` to `first` + size.
    void close_edges(const ivec3& first, int size, Edges& edges) const;
    bool any_within(const ivec3& low, const ivec3& end) const;
    vec3 local(const vec3& node) const { return local_from_index_ * (node - vec3(reference_node_)); }

    const Occluders& occluders_;
    const mat3& local_from_index_;
    ivec3 reference_node_;
};

}  // namespace brisance
