// The table of ways to choose among lights of all kinds together. A way is one row; the key of a shot, its help, the
// methods of a report and the tests read the table. Without one each kind of light has its own choice.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "unified_lights/lights_of_all_kinds.h"
#include "unified_lights/settings.h"

namespace brisance {

using UnifiedGatherer = PointGatherer<LightBySender>;

struct UnifiedLightSampling {
    const char* name;
    const char* help;  // a few words
    std::unique_ptr<UnifiedGatherer> (*make)(const LightsOfAllKinds& lights, const UnifiedLightSettings& settings);
    bool asks_every_light = false;  // time grows like their number
};

const std::vector<UnifiedLightSampling>& unified_light_samplings();

// Null for "none", and for names of no row.
const UnifiedLightSampling* find_unified_light_sampling(const std::string& name);

// "none", and those of the table.
std::vector<std::string> unified_light_sampling_names();

}  // namespace brisance
