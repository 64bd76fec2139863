// The fire of an open shutter in one medium. Moments of a moving medium have different fires: what burns grows as it
// flows apart, and shrinks as it flows together.
#pragma once

#include <span>

#include "medium/medium.h"

namespace brisance {

// The medium, with its fire made as strong as it is in the mean of the moments, of which there is at least one: the sum
// of all voxel lights, channel by channel.
Medium with_mean_fire(Medium medium, std::span<const Medium* const> moments);

}  // namespace brisance
