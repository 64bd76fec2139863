// The files that frames are made of.
#pragma once

#include <filesystem>
#include <vector>

#include "shot/shot.h"
#include "volume/frame_path.h"

namespace brisance {

// Every file that rendering this frame reads, each once: volumes, glTF files with their buffers and pictures, pictures
// of environments. Paths are relative to the current folder as those of the shot are. Throws Error as
// resolve_frame for a missing volume, and as files_of_gltf.
std::vector<std::filesystem::path> input_files(const Shot& shot, const FrameFile& frame);

// Those of the volumes alone, the frame's first and then those of frames by which virtual lights are placed; and those
// of the set, which are the same for all frames.
std::vector<std::filesystem::path> volume_files(const Shot& shot, const FrameFile& frame);
std::vector<std::filesystem::path> set_files(const Shot& shot);

}  // namespace brisance
