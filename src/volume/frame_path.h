// Numbered files: which file belongs to which frame, which frames exist, and which are requested.
//
// Tokens, everywhere in a file name and in folder names: #### and @@@ (as many digits as signs), %04d and %d, $F4 and
// $F, <frame04> and <frame>. Their width is the least number of digits; longer numbers keep all theirs. A single # or @
// in the name of a folder is no token. All tokens of one path stand for the same frame.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace brisance {

bool has_frame_token(const std::string& pattern);

// The path of one frame. A path without tokens comes back as it is.
// Throws Error Usage when something is left that looks like a token or a variable ("$HIP", "%4d", "<udim>").
std::string expand(const std::string& pattern, int frame);

// "1001-1100x2,1200", "1..10", "-5-5": ranges include both ends, x is the step, negative numbers are allowed; frames
// come in the order written, each once. Throws Error Usage (':' is refused: programs disagree about its meaning).
std::vector<int> parse_frames(const std::string& list);

// The frames as a short list for people: "88-90, 92-102"; the input is sorted.
std::string describe_frames(const std::vector<int>& frames);

// The last number in the name of a file without token, before its extension: 15 for "fireball_0015.vdb".
std::optional<int> frame_number_of(const std::filesystem::path& file);

// The pattern of the sequence a numbered file may belong to: "fireball_####.vdb"; unpadded numbers give "#".
std::optional<std::string> pattern_of(const std::filesystem::path& file);

// Frames of a pattern with tokens that exist as files, sorted. Empty when the folder does not exist.
std::vector<int> frames_on_disk(const std::string& pattern);

// The file of one frame. Throws Error MissingInput naming the resolved path and the frames that exist; Usage as expand.
std::filesystem::path resolve_frame(const std::string& pattern, int frame);

struct FrameFile {
    int frame = 0;
    std::filesystem::path file;
};

// One file for each frame. Without `frames` all on disk; a pattern without token is one file: for its own number (or 1)
// without `frames`, for every requested frame when its name holds no number, else for exactly one frame.
// Throws Error as resolve_frame, for the first missing frame; Usage when several frames are requested of a numbered
// file.
std::vector<FrameFile> resolve_sequence(const std::string& pattern, const std::optional<std::vector<int>>& frames);

}  // namespace brisance
