// Which nodes of a lattice see each other past the surfaces between them, for the near field.
//
// Two nodes see each other if a path of open edges joins them that never turns back along an axis. An edge joins nodes
// side by side; it is open if no surface crosses it. Past planes that is exact however they lie: between two nodes on
// one side, the path that first moves away from the plane stays there, and no path reaches the other side. At the rim
// of a surface a path may lead around what the straight line meets, by less than the two nodes lie apart.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "medium/lattice/occluders.h"

namespace brisance {

class LinesOfSight {
public:
    // Keeps references. Node p lies at local_from_index * (p - reference_node), local [m].
    LinesOfSight(const Occluders& occluders, const mat3& local_from_index, const ivec3& reference_node)
        : occluders_(occluders), local_from_index_(local_from_index), reference_node_(reference_node) {}

    // The nodes of a brick, and `margin` more all round.
    class Stencil {
    public:
        // Keeps no reference. Separations reach no farther than the margin.
        Stencil(std::span<const ivec3> separations, int margin);

    private:
        friend class LinesOfSight;
        struct Cell {
            int offset;                      // of the node in the box
            std::array<int, 3> predecessor;  // among the cells, a step nearer along each axis; -1: it is no nearer
            std::array<int, 3> edge;         // offset of the node where the edge between both begins
        };
        int margin_, wide_;
        std::vector<Cell> cells_;                 // the nearest first; the first is the node itself
        std::vector<std::uint32_t> separations_;  // among the cells
    };

    // Of each row along z of a brick's nodes and each separation, in that order, a byte: bit k tells whether the row's
    // node k sees the one that far away. False: all see all, and `seen` is as it was.
    bool look(const Stencil& stencil, const ivec3& first_node, std::vector<std::uint8_t>& seen) const;

private:
    using Edges = std::array<std::vector<std::uint8_t>, 3>;  // along each axis from each node of a box: 1 if open
    void close_edges(const ivec3& low, const ivec3& box, const ivec3& first, int size, Edges& edges,
                     bool& closed) const;
    vec3 local(const vec3& node) const { return local_from_index_ * (node - vec3(reference_node_)); }

    const Occluders& occluders_;
    const mat3& local_from_index_;
    ivec3 reference_node_;
};

}  // namespace brisance
