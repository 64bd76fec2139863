// Greedy elimination in parallel: the survivors are exactly those of the one-by-one algorithm.
//
// One by one, the heaviest point goes, and takes its share from the weights of its neighbours. As weights never grow, a
// point heavier than all of its neighbours goes before any of them, and its weight by then is the one it has now: it
// may go at once, whatever is still to be done elsewhere. So points are removed wherever they are the heaviest around,
// in parallel, and each with the weight at which it went. One by one those weights only fall; the points to go are
// therefore those with the greatest weights at removal, and what was removed beyond them is put back. Weights are
// integers (weight.h): the order of subtraction does not show.
//
// Leaves of sixteen points are the only structure: neighbours are found anew at each removal, for all sixteen at once,
// which is cheaper than reading lists of them from memory.
#pragma once

#include <cstdint>
#include <vector>

#include "elimination/leaves.h"

namespace brisance {

// Who is left of `alive` (indices of candidates, ascending) once `target` remain, with reach multiplied by `scale` and
// neighbours nearer than `least` times the reach counted as if they were there ([1] of eliminate.h, weight limiting).
std::vector<std::uint32_t> eliminate_greedily(const Candidates& candidates, std::vector<std::uint32_t> alive,
                                              std::size_t target, float scale, float least);

// The same one by one, by a heap and lists of neighbours: the textbook's algorithm, as a check and to compare times.
std::vector<std::uint32_t> eliminate_one_by_one(const Candidates& candidates, std::vector<std::uint32_t> alive,
                                                std::size_t target, float scale, float least);

}  // namespace brisance
