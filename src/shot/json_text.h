// JSON with comments, with the line of every key.
#pragma once

#include <map>
#include <string>

#include "codec/codec.h"

namespace brisance {

struct JsonText {
    Json value;
    std::map<std::string, int> line_of_key;  // by dotted path, lines from 1
};

// Throws Error Usage "source:line: ..." for text that is no JSON, and for a key that is there twice.
JsonText parse_json_text(const std::string& text, const std::string& source);

}  // namespace brisance
