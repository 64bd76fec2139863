// A share of the frames of a job, for one task of a farm.
#pragma once

#include <cstddef>
#include <vector>

namespace brisance {

// The task `index`, from 0, of `count`: a contiguous part of `frames`, in their order. Each frame is in the part of
// exactly one task, and parts differ by one frame at most; where there are more tasks than frames, some are empty.
// Neighbouring frames share input files, so they stay together. Throws Error Usage for an index that is not below the
// count, or a count below 1.
std::vector<int> frame_chunk(const std::vector<int>& frames, int index, int count);

// Tasks of at most `per_task` frames each.
int tasks_for(std::size_t frames, int per_task);

}  // namespace brisance
