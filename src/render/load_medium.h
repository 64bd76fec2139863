// From the volume's file to the frame's medium.
#pragma once

#include <filesystem>
#include <vector>

#include "core/progress.h"
#include "medium/medium.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

// Where the shot's further volumes are for a frame, in their order; empty for boxes. Throws Error MissingInput for a
// missing frame.
std::vector<std::filesystem::path> further_files(const Shot& shot, int frame);

// Reads the grids that the shot needs, and no others; `volume` may be empty, then there are only further volumes.
// Throws Error.
Medium load_medium(const Shot& shot, const std::filesystem::path& volume, int frame, Statistics& statistics,
                   Progress& progress);

}  // namespace brisance
