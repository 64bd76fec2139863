// Greedy elimination in parallel: the survivors are exactly those of the one-by-one algorithm.
//
// The one-by-one algorithm removes the heaviest point and subtracts its share from the weights of its neighbours.
// Weights never grow, so a point heavier than all of its neighbours is removed before any of them, with the weight that
// it has now. It may therefore be removed at once, whatever remains to be done elsewhere. Points that are heavier than
// all their neighbours are removed in parallel, and their weights at removal are recorded. In the one-by-one order
// those weights only fall. The points to remove are therefore those with the greatest weights at removal, and any
// others that were removed are restored. Weights are integers (weight.h), so the order of subtraction does not matter.
//
// Leaves of sixteen points are the only structure. Neighbours are found anew at each removal, for all sixteen at once,
// which is cheaper than reading lists of them from memory.
#pragma once

#include <cstdint>
#include <vector>

#include "elimination/leaves.h"

namespace brisance {

// Returns the `target` survivors of `alive` (indices of candidates, ascending). Reach is multiplied by `scale`, and
// neighbours nearer than `least` times the reach count as if at that distance ([1] of eliminate.h, weight limiting).
std::vector<std::uint32_t> eliminate_greedily(const Candidates& candidates, std::vector<std::uint32_t> alive,
                                              std::size_t target, float scale, float least);

// The textbook's one-by-one algorithm with a heap and lists of neighbours, as a check and to compare times.
std::vector<std::uint32_t> eliminate_one_by_one(const Candidates& candidates, std::vector<std::uint32_t> alive,
                                                std::size_t target, float scale, float least);

}  // namespace brisance
