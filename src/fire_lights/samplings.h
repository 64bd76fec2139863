// The table of ways to choose among the lights of the fire. A way is one row; the key of a shot, its help, the methods
// of a report and the tests read the table. The hierarchy is not a row: every row replaces it in MV and, on the base
// of surfaces, in SV.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fire_lights/settings.h"
#include "transport/gather_points.h"

namespace brisance {

class FireLights;
using FireGatherer = PointGatherer<Rgb>;

struct FireLightSampling {
    const char* name;
    const char* help;  // a few words
    std::unique_ptr<FireGatherer> (*make)(const FireLights& lights, const FireLightSettings& settings);
    bool asks_every_light = false;  // time grows like their number: hours where a whole explosion burns
};

const std::vector<FireLightSampling>& fire_light_samplings();

// Null for the hierarchy, and for names of no row.
const FireLightSampling* find_fire_light_sampling(const std::string& name);

// "hierarchy", and those of the table.
std::vector<std::string> fire_light_sampling_names();

}  // namespace brisance
