// Identifies the render that a checkpoint of the path tracer belongs to.
#pragma once

#include <filesystem>
#include <string>

#include "shot/shot.h"

namespace brisance {

// Everything that determines the bits of a path tracer, except when it stops and how its result is used. `volume`: the
// frame's file; empty where the shot has none.
std::string checkpoint_key(const Shot& shot, const std::filesystem::path& volume, int frame);

}  // namespace brisance
