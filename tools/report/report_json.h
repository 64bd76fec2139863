// A report as JSON: what lies beside the page, and what the page draws from.
#pragma once

#include <nlohmann/json.hpp>

#include "report.h"

namespace brisance {

// Numbers that do not exist, or are infinite, are null.
nlohmann::ordered_json report_json(const Report& report);

// Null where the number is infinite or none.
nlohmann::ordered_json json_number(double value);

// "interpolated", "extrapolated", "at_most" or "not_reached".
const char* name_of(ReadingKind kind);

}  // namespace brisance
