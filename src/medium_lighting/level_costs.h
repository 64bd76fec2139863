// Costs of the levels of a hierarchy, for a frame's statistics.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "gathering/gather.h"

namespace brisance {

nlohmann::ordered_json level_table(const std::vector<LevelCost>& costs);
// The largest memory that one level held at a time.
std::uint64_t most_held(const std::vector<LevelCost>& costs);

}  // namespace brisance
