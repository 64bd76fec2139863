// Rejects settings that are valid one by one but contradict each other.
#pragma once

#include <map>
#include <string>

#include "shot/shot.h"

namespace brisance {

// `given` holds the source position of each given key by dotted path. Throws Error Usage.
void check_shot(const Shot& shot, const std::map<std::string, std::string>& given, const std::string& source);

// Why output.layers.bound does not go with the shot's other choices, with what would do; empty where it does, or is not
// asked for.
std::string why_no_bound_layers(const Shot& shot);

}  // namespace brisance
