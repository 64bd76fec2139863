// Whether a frame on disk is finished: whole, readable, and what its shot asks for.
#pragma once

#include <optional>
#include <string>

#include "outputs.h"

namespace brisance {

inline constexpr const char* kNotThere = "it is not there";

// Why the frame has to be rendered: kNotThere, or the file and what is wrong; nothing where it is finished. Reads all
// pixels of its EXRs. `stamp`: what decides its bits (farm/frame_stamp.h). Pictures of virtual lights are not looked
// at.
std::optional<std::string> why_unfinished(const FrameOutput& output, const Shot& shot, const std::string& stamp);

}  // namespace brisance
