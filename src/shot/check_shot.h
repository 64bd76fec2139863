// Settings that are fine one by one and contradict each other.
#pragma once

#include <map>
#include <string>

#include "shot/shot.h"

namespace brisance {

// `given`: where each key that was given stands, by dotted path. Throws Error Usage.
void check_shot(const Shot& shot, const std::map<std::string, std::string>& given, const std::string& source);

}  // namespace brisance
