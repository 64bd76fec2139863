// What is read of one frame of a sequence to make times between frames from it.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "retiming/centred_velocity.h"

namespace brisance {

struct SourceFrame {
    std::vector<std::optional<BlockGrid>> fields;  // by role; the same roles at the same places in every frame
    CentredVelocity velocity;                      // empty where it has none, or none is read
};

// Reads frame number n of a sequence. Throws Error.
using ReadFrame = std::function<SourceFrame(int frame)>;

}  // namespace brisance
