// Smoke whose motion is known in closed form: some Gaussian blobs that a steady velocity carries without deforming.
#pragma once

#include <vector>

#include "retiming/between_frames.h"
#include "retiming/choose_retiming.h"

namespace brisance::testing {

constexpr double kVoxel = 0.1;  // [m]

struct Blob {
    dvec3 centre;  // at time 0 [voxels]
    double sigma;  // [voxels]
    double amount;
};

// A rotation around the z axis and a translation, in voxels and radians per frame.
struct RigidMotion {
    dvec3 velocity{0.0};
    double spin = 0.0;
    dvec3 place(const dvec3& at_time_0, double time) const;
    dvec3 velocity_at(const dvec3& p) const;  // of the steady field; exact for spin or translation alone
};

struct MovingSmoke {
    std::vector<Blob> blobs = {{{14.0, 3.0, 1.0}, 3.0, 1.0}};
    RigidMotion motion;
    double unit = 1.0;  // velocities are stored as voxels per frame divided by this

    double density(const dvec3& p, double time) const;
    BlockGrid grid(double time, const ivec3& shift = ivec3(0)) const;
    // Velocity is there only where smoke is.
    BlockGrid velocity(double time) const;
    SourceFrame frame(double time) const;
    BetweenFrames pair(double first, double second, double time) const;
};

// Some blobs around the axis that turn.
MovingSmoke turning_smoke(double spin);

constexpr VelocitySettings kVoxelsPerFrame{VelocityUnit::VoxelFrame, 1.0, 24.0};

}  // namespace brisance::testing
