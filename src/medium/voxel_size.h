// Sizes of a medium's voxels, which need not be cubes.
#pragma once

#include "medium/medium.h"

namespace brisance {

// Of a voxel [m].
float longest_edge(const Medium& medium);
float longest_diagonal(const Medium& medium);

}  // namespace brisance
