// Keys that had another name before.
#pragma once

#include <optional>
#include <string>

namespace brisance {

// What to say of a key that was renamed or taken out, with what takes its place; nothing for other keys. A section, or
// a key: "particles", "particles.paths".
std::optional<std::string> renamed_key(const std::string& path);

// The same for a value that was renamed; `text`: the value as JSON.
std::optional<std::string> renamed_value(const std::string& path, const std::string& text);

}  // namespace brisance
