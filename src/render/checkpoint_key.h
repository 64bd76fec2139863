// What a checkpoint of the path tracer belongs to.
#pragma once

#include <filesystem>
#include <string>

#include "shot/shot.h"

namespace brisance {

// Everything that decides a path tracer's bits, but for when it stops and what becomes of them. `volume`: the frame's
// file; empty where the shot has none.
std::string checkpoint_key(const Shot& shot, const std::filesystem::path& volume, int frame);

}  // namespace brisance
