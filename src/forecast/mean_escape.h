// How much of the light that a medium scatters gets out of it at once: the number by which haze and dense smoke differ
// whatever files or boxes hold them.
#pragma once

#include "medium/medium.h"

namespace brisance {

// The probability that light which the medium has scattered leaves it without another collision: the mean over all
// directions and over all points, in proportion to their scattering coefficient. 1 where nothing scatters. Surfaces are
// ignored. By a fixed number of rays without random numbers: within 0.01 of the truth, and within that for the same
// smoke on other voxels.
double mean_escape(const Medium& medium);

}  // namespace brisance
