// Keys that had another name before.
#pragma once

#include <optional>
#include <string>

namespace brisance {

// Returns the message for a section or key that was renamed or removed ("particles", "particles.paths"), with its
// replacement, and nothing for other keys.
std::optional<std::string> renamed_key(const std::string& path);

// The same for a value that was renamed; `text`: the value as JSON.
std::optional<std::string> renamed_value(const std::string& path, const std::string& text);

}  // namespace brisance
