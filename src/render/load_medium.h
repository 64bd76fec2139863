// Loads the volume files of a frame as its medium.
#pragma once

#include <filesystem>
#include <vector>

#include "core/progress.h"
#include "medium/medium.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

struct KeptInputs;

// Paths of the shot's further volumes for a frame, in their order; empty for boxes. Throws Error MissingInput for a
// missing frame.
std::vector<std::filesystem::path> further_files(const Shot& shot, int frame);

// Reads only the grids that the shot needs. `volume` may be empty, if there are only further volumes. `kept`: takes
// from it what was read ahead, and notes there what this frame read. Throws Error.
Medium load_medium(const Shot& shot, const std::filesystem::path& volume, int frame, Statistics& statistics,
                   Progress& progress, KeptInputs* kept = nullptr);

}  // namespace brisance
