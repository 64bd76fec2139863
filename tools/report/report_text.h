// A report as tables: CSV (RFC 4180) for programs, and text for whoever waits.
#pragma once

#include <string>

#include "report.h"

namespace brisance {

// One row for each run and layer.
std::string measurements_csv(const Report& report);

// One row for each method, layer, clock and error.
std::string times_csv(const Report& report);

// Time to reach an error, of the beauty, by wall time.
std::string times_table(const Report& report);

}  // namespace brisance
