// Loads the shot of a command line: a shot file, or a bare .vdb with settings suggested from its values.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "shot/read_shot.h"
#include "shot/shot.h"
#include "volume/frame_path.h"

namespace brisance {

// `input` ending in .vdb, with or without frame tokens, gets the shot that `inspect` suggests for it (for the largest
// file of a sequence, so that every frame gets the same); anything else is a shot file. Throws Error.
Shot load_shot(const std::string& input, const ShotOptions& options, Progress& progress);

// The volume's path or pattern, seen from the current folder.
std::string volume_pattern(const Shot& shot);

// Returns the frames of a shot and their .vdb files; of two files that a frame is made from, the nearer. Where the shot
// has no volume, or nothing is at a frame's time, files are empty. Without requested frames all that show the sequence,
// or frame 1 where there is no volume. Throws Error as resolve_sequence and own_files.
std::vector<FrameFile> resolve_frames(const Shot& shot, const std::optional<std::vector<int>>& requested);

}  // namespace brisance
