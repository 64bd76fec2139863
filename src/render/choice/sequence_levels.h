// One choice of lattices for all frames of a sequence, and of the mean escape probability by which solutions of
// scattered light are mixed. A frame that chooses for itself may be solved on another lattice than its neighbours,
// which shows as a jump of about a percent.
#pragma once

#include <filesystem>

#include "core/progress.h"
#include "shot/shot.h"

namespace brisance {

// Whether the shot leaves lighting.levels, lighting.lattice_level, lighting.smoke_lattice_level or scattering.escape
// open and its method looks at them.
bool leaves_levels_open(const Shot& shot);

// The shot with these as the medium of this frame has them; what the shot states stays. Reads the frame's files. Which
// frame that is must not depend on those that are rendered: the largest file of the sequence. Throws Error.
Shot with_levels_of(Shot shot, const std::filesystem::path& volume, int frame, Progress& progress);

}  // namespace brisance
