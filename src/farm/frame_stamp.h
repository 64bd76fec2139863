// What decides the bits of a frame, as a text in the header of its EXR: whether a finished frame is still the one that
// a shot asks for.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "shot/shot.h"
#include "volume/frame_path.h"

namespace brisance {

inline constexpr const char* kStampKey = "brisance/inputs";

// Makes the stamps of a shot's frames: the program's version, the settings as they were asked for (write_shot.h), and
// the contents of all input files. Files that several frames share are read once.
class FrameStamps {
public:
    // `deciding`: files that decide something for all frames, such as the one by which a method is chosen.
    FrameStamps(const Shot& shot, std::string version, const std::vector<std::filesystem::path>& deciding = {});

    // JSON, the same for equal frames wherever their files lie. Throws Error MissingInput or BadData.
    std::string of(const FrameFile& frame);

    // A short form of it: 16 hexadecimal digits.
    static std::string hash_of(const std::string& stamp);

private:
    const std::string& hash_of_file(const std::filesystem::path& file);

    Shot shot_;
    std::string version_, settings_;
    std::vector<std::filesystem::path> deciding_;
    std::optional<std::vector<std::filesystem::path>> set_;
    // Of volumes only the last frame's are likely to come again, but a hash is short.
    std::map<std::filesystem::path, std::string> hashes_;
};

// Why a frame with the stamp `found` is not the one with the stamp `wanted`, in a few words; nothing where it is.
std::optional<std::string> stamp_difference(const std::string& found, const std::string& wanted);

}  // namespace brisance
