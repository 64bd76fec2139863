// Text from outside as part of one line: names in files, values of shots, messages of libraries.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace brisance {

constexpr std::size_t kLongestName = 120;     // of a name in a message [characters]
constexpr std::size_t kLongestMessage = 160;  // of a library's message

// Valid UTF-8 on one line: control characters and those that turn the direction of writing become spaces, what is no
// UTF-8 becomes U+FFFD, spaces at the end go. After `longest` characters, the rest is "...".
std::string printable(std::string_view text, std::size_t longest = kLongestMessage);

// The same for a whole line of ours, which may hold paths: cut only where no reader would follow it.
std::string printable_line(std::string_view line);

}  // namespace brisance
