// What the levels of a hierarchy cost, for a frame's statistics.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "gathering/gather.h"

namespace brisance {

nlohmann::ordered_json level_table(const std::vector<LevelCost>& costs);
// Of all levels, the most memory that one held at once.
std::uint64_t most_held(const std::vector<LevelCost>& costs);

}  // namespace brisance
