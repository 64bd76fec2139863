// What a file or a text holds, as a short number: whether two of them are the same. No defence against forgery.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace brisance {

// XXH3 with 64 bits, as 16 hexadecimal digits.
std::string content_hash(std::string_view bytes);

// The same of a file, which is read in pieces. Throws Error MissingInput (not there) or BadData (cannot be read).
std::string content_hash_of_file(const std::filesystem::path& file);

}  // namespace brisance
