// The energy balance of flights as a row of the frame's statistics.
#pragma once

#include <string>

#include "scattering/bounce_balance.h"
#include "statistics/statistics.h"

namespace brisance {

// `orders`: how often the light had scattered before, "1-12" for several flights together, or a word for it.
nlohmann::ordered_json balance_row(const BounceBalance& balance, const std::string& orders);

}  // namespace brisance
