// Renders of one step that differ in their random numbers alone, and what their errors say together.
#pragma once

#include <set>
#include <span>

#include "report.h"
#include "shot/shot.h"

namespace brisance {

// The shot of a repeat, from 0, which is the shot itself: others have other seeds, so that their pictures are
// independent where the method draws random numbers. Path tracers take no seed of `taken`.
Shot shot_of_repeat(const Shot& shot, int repeat, const std::set<int>& taken);

// The mean of every measure over the repeats, at least one, with `spread` where the pictures differ. Of pixels that are
// not finite it has the largest number; it is below the noise where one repeat is.
LayerErrors mean_errors(std::span<const LayerErrors> repeats, bool pictures_differ);

// The cost of the repeat whose wall time is the median; of an even number the lower one.
Cost median_cost(std::span<const Cost> repeats);

}  // namespace brisance
