// Light at the nodes of a medium, from that at every second one.
//
// Light of the levels above the near field comes from some voxels away. It is smooth, but for what the smoke just
// around a node holds back, and that is known for every node: the mean depth over directions of the way from the
// nearest such lights. So light at every second node is taken to where it enters that smoke, interpolated, and taken
// through the smoke around each node (interpolated: light_roots.h).
//
// A sixteenth of the nodes gather the nearest level themselves. How much more or less collides by their own light
// changes slowly from place to place (local_ratios.h), and is made up for in proportion to the axes along which a node
// lies between two that gather: no light is gained or lost. The built-in explosion errs by 1.9 instead of 1.8 %, with
// all nodes gathering, and two explosions and a fireball by 2.9 instead of 3.0, 0.7 and 0.7, 1.9 and 1.8 %.
#pragma once

#include <span>
#include <vector>

#include "gathering/local_ratios.h"
#include "gathering/node_receivers.h"

namespace brisance {

class LightBetween {
public:
    // `coarser`: every second node of the pyramid's medium. `mean_extinction`: there, of the smoke in which separations
    // see it [1/m]. `reach`: of the smoke around a node [m]. Keeps references to the first and the third.
    LightBetween(const ExtinctionPyramid& pyramid, const std::vector<float>& mean_extinction,
                 const NodeReceivers& coarser, float reach, const Occluders* surfaces = nullptr);

    // Adds light at the coarser nodes to `sum`, as it is before it enters the smoke around them. `in_mean_extinction`:
    // which light has gone through the smoke of the coarser lattice.
    void add(const Gathered& values, bool in_mean_extinction, Gathered& sum) const;

    // Of the nodes that `needed` marks, those whose own light is compared with that between others: a sixteenth, spread
    // evenly, in rows that stay where they are in the world.
    std::vector<std::uint8_t> compared_nodes(const std::vector<std::uint8_t>& needed) const;

    // Sets `out` at marked nodes to the light between the nodes of `sum`.
    void set(const Gathered& sum, const std::vector<std::uint8_t>& marked, Gathered& out) const;

    // Mixes the light of marked nodes in `out`, `own_share` of it, with that between the nodes of `sum`, after this has
    // been made to collide as much as the own light of compared nodes.
    void mix(const Gathered& sum, const std::vector<std::uint8_t>& compared, const std::vector<std::uint8_t>& marked,
             float own_share, Gathered& out) const;

private:
    struct Interpolant {
        Gathered roots;                             // light_roots.h
        std::vector<std::vector<float>> curvature;  // second differences, three for each plane of light
        std::size_t lights;                         // planes of light
    };
    Interpolant interpolant_of(const Gathered& sum) const;

    // Along each axis, per coarser node: 0 where a neighbour does not gather, or surfaces may part it from the node.
    std::vector<std::vector<float>> second_differences(std::span<const float> values) const;

    // Calls take(node, light) with the light between at marked nodes, from several threads.
    template <class Take>
    void for_each_between(const Interpolant& of, const std::vector<std::uint8_t>& marked, const Take& take) const;

    LocalRatios excess_of_own(const Interpolant& between, const std::vector<std::uint8_t>& compared,
                              const Gathered& out) const;

    const Medium& medium_;
    const NodeReceivers& coarser_;
    std::vector<float> depth_;          // of the smoke around nodes of the medium
    std::vector<float> mean_depth_;     // of that around nodes of the coarser lattice
    std::vector<std::uint8_t> smooth_;  // per brick of the coarser lattice: no surface is near
};

}  // namespace brisance
