// The lattices at whose nodes light of each level is gathered, and the way back to the finest.
//
// A level's shadow maps know its light no finer than by about a quarter of the level's own spacing: their texels, and
// their steps along a ray, are as long. At the least distance of such a light, an interpolant over that length errs by
// some thousandths. So the light of level l is gathered at every 2^m-th node, with 2^m at most an eighth of the
// level's blending radius, and interpolated to the nodes between, coarsest lattice first. This is for an error of 2 %;
// where less is asked for, the distance falls as its power 3/2; where more is allowed, it grows as its square root. All
// light of far levels together then costs less than that of the nearest.
//
// Surfaces in the medium end light at once: nodes that do not see all the coarse ones around them gather for themselves
// (medium/lattice/corners_seen.h). Beyond the edges of surfaces the shadow of a light that stands for many voxels fades
// over a width like that of the interpolant, since it is cut at places all over these voxels.
#pragma once

#include <vector>

#include "gathering/gather.h"

namespace brisance {

// The nodes of a lattice that need light, as receivers.
struct NodeReceivers {
    BrickLattice lattice;
    std::vector<std::uint8_t> needed;    // per node
    Receivers receivers;                 // the needed nodes of every brick as one block
    std::vector<std::uint32_t> node_of;  // per receiver
};

// The requested nodes of the pyramid's medium.
NodeReceivers node_receivers(const Medium& medium, const LatticeRequest& request);

// Those of them that are marked.
NodeReceivers marked_receivers(const Medium& medium, const LatticeRequest& request,
                               const std::vector<std::uint8_t>& marked);

// Every second node per axis: those with a share in the interpolation at some needed node of `fine`. `coarsening`: of
// the result, relative to the medium.
NodeReceivers coarser_receivers(const Medium& medium, const LatticeRequest& request, const NodeReceivers& fine,
                                int coarsening);

// Needed nodes of `fine`, which is as coarse, in two parts: those that see all nodes of the coarser lattice around
// them, without receivers, and the others.
struct NodesBesideSurfaces {
    NodeReceivers in_the_open, beside;
};
NodesBesideSurfaces part_beside_surfaces(const Medium& medium, const LatticeRequest& request, const NodeReceivers& fine,
                                         int coarsening, const Occluders& occluders);

// The same by the surfaces within `reach` [m] of the bricks that hold the nodes.
NodesBesideSurfaces part_within_reach(const Medium& medium, const LatticeRequest& request, const NodeReceivers& nodes,
                                      int coarsening, float reach, const Occluders& occluders);

// By how many halvings of the lattice a level's receivers may be fewer than the medium's nodes.
int coarsening_of(const LightField& field, const GridLevel& level);

// Adds `values`, one per receiver and channel, to `out`, planar over the nodes.
void add_at_nodes(const NodeReceivers& from, const Gathered& values, Gathered& out);

// Adds light at the nodes of a lattice to the needed nodes of one twice as fine, trilinearly.
void add_interpolated(const NodeReceivers& from, const Gathered& values, const NodeReceivers& to, Gathered& out);

}  // namespace brisance
