// The medium at other moments of an open shutter.
//
// Within the shutter the velocity field stands still and carries everything along. What is at a node at another moment
// was at the frame itself at the other end of its streamline, which is traced backward in midpoint steps of at most one
// node (semi-Lagrangian advection: Stam, Stable Fluids, SIGGRAPH 1999). Every moment is traced from the frame itself,
// so that no smoothing adds up. Optical coefficients are moved, not grids: extinction is linear in density, and a mean
// of media is never taken. What flows apart is not thinned out.
#pragma once

#include <vector>

#include "medium/medium.h"
#include "medium_lighting/node_sources.h"
#include "motion/velocity_around.h"

namespace brisance {

// Where the nodes of a lattice were: in nodes, relative to the medium's reference node.
struct Origins {
    std::vector<vec3> at_nodes;
};

class MovingMedium {
public:
    // `medium` has a velocity. `reach`: the most frames, forward or back, for which it will be asked.
    MovingMedium(const Medium& medium, double reach);

    // The largest velocity [m per frame] times the reach [m].
    float largest_distance() const { return largest_distance_; }

    // Where the nodes of `lattice` were `frames` earlier.
    Origins origins(const BrickLattice& lattice, double frames) const;

    // The medium `frames` after its own moment, in the same local space.
    Medium at(double frames) const;

private:
    vec3 velocity(const vec3& node) const;  // trilinear [nodes per frame]
    vec3 origin(vec3 node, double frames) const;

    const Medium& medium_;
    float largest_distance_;
    VelocityAround around_;
};

// Source functions of the medium `from` at the nodes that have these origins. Values are means weighted by extinction,
// so that light scattered per metre is kept.
NodeSources moved_sources(const NodeSources& sources, const Medium& from, const Origins& origins);

}  // namespace brisance
