// JSON with comments, with the line of every key.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "codec/codec.h"

namespace brisance {

struct JsonText {
    Json value;
    std::map<std::string, int> line_of_key;  // by dotted path, lines from 1
};

// Throws Error Usage "source:line: ..." for text that is no JSON, for a key that is there twice, and for values nested
// more than 256 levels deep.
JsonText parse_json_text(const std::string& text, const std::string& source);

// Nothing where the text is no JSON, or nested more than 256 levels deep, or with more than
// 10,000 keys.
std::optional<Json> parse_json_value(const std::string& text);

// The value at a dotted path; objects on the way are made.
Json& at_path(Json& root, const std::string& path);

}  // namespace brisance
