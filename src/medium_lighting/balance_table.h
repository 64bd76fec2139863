// The energy balance of one flight as a row of the frame's statistics.
#pragma once

#include <string>

#include "scattering/multiple_scattering.h"
#include "statistics/statistics.h"

namespace brisance {

// `order`: how often the light had scattered before, or a word for it.
nlohmann::ordered_json balance_row(const BounceBalance& balance, const std::string& order);

}  // namespace brisance
