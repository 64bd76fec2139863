// Velocities of a file as one vector at each node, whatever form they are stored in.
#pragma once

#include <cstdint>
#include <vector>

#include "retiming/settings.h"
#include "volume/vdb_file.h"

namespace brisance {

struct CentredVelocity {
    BlockGrid grid;              // three channels, in the file's unit; 0 where nothing is known
    double typical = 0.0;        // 99th percentile of the lengths above zero
    double largest = 0.0;        // as stored
    double limit = 0.0;          // lengths are clamped to this multiple of the typical one
    std::uint64_t outliers = 0;  // vectors that were
    bool empty() const { return grid.empty() || typical <= 0.0; }
};

// Velocity as its file has it: one grid of three channels, or three of one. Empty: none.
using VelocityGrids = std::vector<BlockGrid>;

// Joins three grids of one channel, takes faces of staggered grids to the centres between them, and clamps outliers.
// A face of component i lies half a voxel below its node along axis i, as OpenVDB's class "staggered" has it.
CentredVelocity centred_velocity(const VelocityGrids& grids);

// From a vector of the file to voxels of the target lattice per frame. VelocityUnit::Automatic counts as Frame, which
// is what a fitted scale means.
dmat3 voxels_per_frame(const VelocitySettings& settings, const dmat4& world_from_velocity,
                       const dmat4& world_from_target);

}  // namespace brisance
