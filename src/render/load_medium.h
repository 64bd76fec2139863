// From the volume's file to the frame's medium.
#pragma once

#include <filesystem>

#include "core/progress.h"
#include "medium/medium.h"
#include "render/statistics.h"
#include "shot/shot.h"

namespace brisance {

// Reads the grids that the shot needs, and no others. Throws Error.
Medium load_medium(const Shot& shot, const std::filesystem::path& volume, Statistics& statistics, Progress& progress);

}  // namespace brisance
