// The first level of lights above a lattice's own nodes, at the nodes of that lattice or at every second one, without
// shadow maps.
//
// A light of this level stands near a vertex, which is an even node: at most one node away from it per axis, since it
// represents the nodes around the vertex. Receivers are nodes too. So the separation of vertex and receiver takes a few
// hundred values for each of the eight parities of the receiver, and the optical depth along it is a fixed linear
// combination of extinctions, as in the near field. The light's shift from its vertex changes that depth to first
// order, by another such combination (separation_depth.h); distance, direction and blend are those of the light itself.
// The built-in explosion errs by 1.7 % so, by 1.8 % with rays from the lights, and by 2.5 % with lights at their
// vertices.
//
// Shadow maps of this level would hold about as many values as there are receivers that read them, and would be many
// times larger than the caches. Extinctions of neighbouring receivers lie side by side.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lighting_grid/lighting_grid.h"
#include "medium/lattice/extinction_pyramid.h"
#include "near_field/separation_depth.h"
#include "receivers/receivers.h"

namespace brisance {

class FirstLevel {
public:
    // `local_from_index` spans the lattice [m per node]. Lights fade in over [radius / 2, radius] and out over
    // [radius, 2 radius] [m].
    FirstLevel(const mat3& local_from_index, float radius);

    // Whether a lattice has few enough separations: voxels far from cubic, or large radii, have many.
    static bool is_small(const mat3& local_from_index, float radius);

    struct Input {
        const ExtinctionPyramid* pyramid;      // whose level below that of the lights is the lattice
        const std::vector<float>* extinction;  // at its nodes [1/m]
        const GridLevel* lights;
        std::optional<vec3> eye;  // local [m]; none: no `scattered`
        float mean_cosine = 0.0f;

        int lattice_level() const { return lights->level - 1; }
        vec3 local_of_node(const ivec3& node) const {
            return pyramid->medium().local_of_node(node * (1 << lattice_level()));
        }
    };

    // The nodes that need light: of the lattice itself, or (every_second) of its even nodes.
    struct Targets {
        const BrickLattice* lattice;
        const std::vector<std::uint8_t>* needed;
        bool every_second;
    };

    // Adds to `out`, whose arrays are planar over the targets' nodes. Returns the number of light evaluations.
    std::uint64_t gather(const Input& input, const Targets& targets, Gathered& out) const;

    struct Separation {
        ivec3 vertex;    // of the light from the receiver's cell of two nodes, in cells
        vec3 to_vertex;  // from the receiver [m]
        bool own;        // the receiver is at the vertex: the depth is its extinction times the light's distance
        std::vector<ShiftedTap> taps;
    };
    // `parity`: of a receiver at node 2 c + parity, c being its cell.
    const std::vector<Separation>& separations(int parity) const { return separations_[parity]; }
    static ivec3 parity(int p) { return {p >> 2, p >> 1 & 1, p & 1}; }
    int margin() const { return margin_; }  // of cells around a receiver's cell that count
    float radius() const { return radius_; }
    float longest_reach() const { return longest_reach_; }  // from a receiver to a light [m]

private:
    float radius_, longest_reach_;
    int margin_ = 1;
    std::vector<Separation> separations_[8];
};

}  // namespace brisance
