// Files that are read: there, regular, and readable. A device or a pipe may never end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/error.h"

namespace brisance {

// Returns the size of `file`. Throws Error MissingInput when it is not there, and `unusable` when it is a folder, a
// device or a pipe, or may not be read. `remedy` ends the message about a missing file.
std::uint64_t size_of_input(const std::filesystem::path& file, ExitCode unusable = ExitCode::BadData,
                            const std::string& remedy = "");

// All bytes of `file`. Throws as size_of_input, and `unusable` when there are more than `most`.
std::string read_input(const std::filesystem::path& file, std::uint64_t most, ExitCode unusable = ExitCode::BadData);

}  // namespace brisance
