// Which key was probably meant.
#pragma once

#include <string>
#include <vector>

namespace brisance {

// Insertions, deletions, replacements and exchanges of neighbours that lead from one text to the other.
int edit_distance(const std::string& a, const std::string& b);

// Returns the known dotted path most like `path`, by the whole or by its last part in another section.
std::string nearest_key(const std::string& path, const std::vector<std::string>& known);

}  // namespace brisance
