// Loads the shot of a command line: a shot file, or a bare volume with a first look.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "first_look/look.h"
#include "shot/read_shot.h"
#include "shot/shot.h"
#include "volume/frame_path.h"

namespace brisance {

inline constexpr const char* kDecideLook = "auto";

struct LoadedShot {
    Shot shot;
    std::optional<Look> look;                      // decided here, from the frames on disk
    std::vector<std::filesystem::path> looked_at;  // by which the look or the camera was decided here
};

// The volumes of a command line: a .vdb, a pattern of several, or a folder that holds those of one sequence, which
// gives its pattern. Throws Error: MissingInput (no .vdb in the folder), Usage (several sequences in it).
std::string volume_input(const std::string& input);

// `input`: a shot file, a glTF file, or volumes as volume_input takes them. Volumes get a first look, decided from the
// whole sequence on disk. `look`: a file of one to use instead; with a shot, the look decides what the shot leaves
// open, and "auto" decides one; empty: none beside a camera where the shot has none. Throws Error.
LoadedShot load_shot_and_look(const std::string& input, const ShotOptions& options, const std::string& look,
                              Progress& progress);
Shot load_shot(const std::string& input, const ShotOptions& options, Progress& progress);

// The look of volumes with nothing stated beside `options`.
Look first_look(const std::string& volumes, const ShotOptions& options, Progress& progress);

// The volume's path or pattern, seen from the current folder.
std::string volume_pattern(const Shot& shot);

// Returns the frames of a shot and their .vdb files; of two files that a frame is made from, the nearer. Where the shot
// has no volume, or nothing is at a frame's time, files are empty. Without requested frames all that show the sequence,
// or frame 1 where there is no volume. Throws Error as resolve_sequence and own_files.
std::vector<FrameFile> resolve_frames(const Shot& shot, const std::optional<std::vector<int>>& requested);
// The same by the shot's own volume alone, whatever its further volumes have at these frames.
std::vector<FrameFile> own_frames(const Shot& shot, const std::optional<std::vector<int>>& requested);

}  // namespace brisance
