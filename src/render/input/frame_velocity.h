// The velocity of a frame's smoke, for motion blur.
#pragma once

#include <optional>

#include "retiming/between_frames.h"

namespace brisance {

// Of the world's axes, in metres per frame of the picture, on the lattice of the file's velocity. `rate`: frames of the
// sequence per frame of the picture. `settings`: with a settled unit. None where nothing moves.
std::optional<BlockGrid> frame_velocity(const CentredVelocity& velocity, const VelocitySettings& settings, double rate,
                                        const dmat4& world_from_file);

// The same at a time between two frames: the mean of both velocities, weighted by time.
std::optional<BlockGrid> frame_velocity(const BetweenFrames& pair, const VelocitySettings& settings, double rate,
                                        const dmat4& world_from_file);

}  // namespace brisance
