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

// Paths of the shot's further volumes for a frame, in their order, of two files the nearer; empty for boxes and where
// nothing is at this time. Throws Error MissingInput for a missing frame.
std::vector<std::filesystem::path> further_files(const Shot& shot, int frame);

// Reads only the grids that the shot needs. `volume` may be empty, if there are only further volumes. Where the shot's
// times differ from the frame's number, the shot says which files are read. What it leaves open of retiming is settled
// here, as settle_time does; settling it before saves that in each frame. `kept`: takes from it what was read ahead,
// and notes there what this frame read. Throws Error.
Medium load_medium(const Shot& shot, const std::filesystem::path& volume, int frame, Statistics& statistics,
                   Progress& progress, KeptInputs* kept = nullptr);

}  // namespace brisance
