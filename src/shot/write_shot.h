// A shot back as JSON, and what can be said of shots in general.
#pragma once

#include <string>

#include "shot/shot.h"

namespace brisance {

// Every setting with its value, as parse_shot reads it. Framed cameras are left open, as they are in the shot.
std::string to_json(const Shot& shot);

// 64-bit FNV-1a of to_json without output.path, as 16 hexadecimal digits: equal settings, equal hash, wherever written.
std::string settings_hash(const Shot& shot);

// JSON Schema (draft 2020-12) of shot files.
std::string shot_schema();

// All keys for people: path, what is expected, default, meaning.
std::string shot_keys_text();

}  // namespace brisance
