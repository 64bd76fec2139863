#include "medium_lighting/level_costs.h"

#include <algorithm>

namespace brisance {

nlohmann::ordered_json level_table(const std::vector<LevelCost>& costs) {
    auto table = nlohmann::ordered_json::array();
    for (const LevelCost& c : costs)
        table.push_back({{"level", c.level},
                         {"lights", c.lights},
                         {"resolution", c.resolution},
                         {"distances", c.distances},
                         {"map_bytes", c.map_bytes},
                         {"held_bytes", c.held_bytes},
                         {"map_seconds", c.map_seconds},
                         {"gather_seconds", c.gather_seconds},
                         {"evaluations", c.evaluations}});
    return table;
}

std::uint64_t most_held(const std::vector<LevelCost>& costs) {
    std::uint64_t most = 0;
    for (const LevelCost& c : costs)
        most = std::max(most, c.held_bytes);
    return most;
}

}  // namespace brisance
