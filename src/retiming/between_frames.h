// A time between two frames of a sequence, made from both.
#pragma once

#include <string>

#include "retiming/settings.h"
#include "retiming/source_frame.h"

namespace brisance {

struct BetweenFrames {
    SourceFrame first, second;
    double weight = 0.5;  // share of the way from the first to the second, in (0, 1)
    int frames = 1;       // of the sequence between both
    std::string where;    // begins messages
};

using Fields = std::vector<std::optional<BlockGrid>>;

// Fields on the first frame's lattices (the second's where the first has none), on the bricks of both frames: the mean
// of both frames, weighted by time, voxel by voxel.
Fields blended(const BetweenFrames& pair);

// The same from both frames moved to this time along their velocity, on the bricks that they move to. Values are
// traced back by Motion::moved and interpolated as in MacCormack's scheme (A. Selle et al., An unconditionally stable
// MacCormack method, 2008): half of what is lost when values are moved there and back is added, and the result clamped
// to the eight nodes that it comes from. Unlike there the loss is taken where a value comes from, not where it goes:
// they are many voxels apart. Without velocity in either frame nothing moves. Throws Error as motion_between.
Fields advected(const BetweenFrames& pair, const VelocitySettings& velocity);

}  // namespace brisance
