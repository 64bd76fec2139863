// How points move between two frames of a sequence.
#pragma once

#include <array>
#include <vector>

#include "medium/lattice/brick_lattice.h"
#include "retiming/centred_velocity.h"

namespace brisance {

// Velocities of both frames on one lattice. Between the frames they are blended in time, where they are: at a share t
// of the way, (1 - t) of the first frame's and t of the second's.
struct Motion {
    BrickLattice lattice;
    std::vector<float> voxels;  // per node, the first frame's and then the second's: voxels over the way between both

    // Where what is at `p` at the share `from` of the way has moved at the share `to`; in nodes of the lattice.
    // Midpoint steps of at most one voxel. All velocities are multiplied by `scale`.
    dvec3 moved(dvec3 p, double from, double to, double scale = 1.0) const;
};

// One frame's part in a motion.
struct MovingFrame {
    const CentredVelocity& velocity;
    std::vector<std::uint8_t> smoke;  // per node of `smoke` below: whether anything is there
};

// `smoke`: the bricks of both frames' fields, which are on a lattice of the transform `world_from_index`. Nodes that
// have neither velocity nor smoke, up to a brick beyond it, take the mean of their neighbours', layer after layer.
// `frame_count`: of the sequence between both.
Motion motion_between(const std::array<MovingFrame, 2>& frames, const BrickLattice& smoke,
                      const dmat4& world_from_index, const VelocitySettings& settings, int frame_count);

}  // namespace brisance
