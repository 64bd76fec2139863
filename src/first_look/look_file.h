// A look as a file, so that it can be kept, changed and used for every part of a sequence.
#pragma once

#include <filesystem>
#include <string>

#include "first_look/look.h"

namespace brisance {

inline constexpr const char* kLookSuffix = ".look.json";

std::string look_to_json(const Look& look);

// `source` begins messages. Throws Error Usage with one line: no JSON, no look, a part of it missing or of the wrong
// kind, or a decision that no key of a shot accepts. What joins several keys is checked where they become a shot.
Look look_from_json(const std::string& text, const std::string& source);

// Throws as look_from_json, and MissingInput where there is no such file.
Look read_look(const std::filesystem::path& file);

}  // namespace brisance
