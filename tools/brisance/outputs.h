// The output files of each frame.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "diagnostics/write_light_pictures.h"
#include "shot/shot.h"
#include "volume/frame_path.h"

namespace brisance {

struct FrameOutput {
    std::filesystem::path exr;
    std::filesystem::path png;                    // empty: not wanted
    std::filesystem::path statistics;             // STEM.stats.json; empty: not wanted
    std::array<std::filesystem::path, 2> halves;  // STEM.A.exr and STEM.B.exr; empty: not wanted
    LightPictureFiles lights;                     // STEM.virtual_lights.*; empty: not wanted
};

// One output for each frame, whether or not it can be written. `several`: the frames belong to a sequence, and their
// names must tell them apart, also where this process renders one of them alone. `requested`: the EXR of the command
// line, or a folder for it, relative to the current folder; empty: the shot's, relative to the shot's folder; if that
// is empty too, the shot's name in the current folder. Throws Error Usage (no .exr; several frames would get one name).
std::vector<FrameOutput> name_outputs(const Shot& shot, const std::string& requested,
                                      const std::vector<FrameFile>& frames, bool several);

// Readies the outputs for writing: `input` is never overwritten. Throws Error Usage (it would be), CannotCreate or
// OutputFailed when a folder is missing or cannot be written into. `make_folders` makes those that are missing.
void check_outputs(const std::vector<FrameOutput>& outputs, const std::filesystem::path& input, bool make_folders);

// All files of a frame.
std::vector<std::filesystem::path> files_of(const FrameOutput& output);

// The file of a first look beside the EXRs: their name without the frame number, and ".look.json". Arguments as of
// plan_outputs. Throws Error CannotCreate or OutputFailed when it cannot be written.
std::filesystem::path plan_look(const Shot& shot, const std::string& requested, bool several,
                                const std::filesystem::path& input);

// One checkpoint for each frame: `requested` with the frame's number in it, or nothing for all when it is empty. Throws
// Error Usage (no frame token for several frames; the method keeps none; it is a file that is read or written as
// something else), CannotCreate or OutputFailed as check_outputs.
std::vector<std::filesystem::path> plan_checkpoints(const Shot& shot, const std::string& requested,
                                                    const std::vector<FrameFile>& frames,
                                                    const std::vector<FrameOutput>& outputs,
                                                    const std::filesystem::path& input, bool several);

}  // namespace brisance
