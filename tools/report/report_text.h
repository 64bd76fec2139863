// A report as tables: CSV (RFC 4180) for programs, and text for the terminal.
#pragma once

#include <string>

#include "report.h"

namespace brisance {

// One row for each run and layer.
std::string measurements_csv(const Report& report);

// One row for each method, layer, clock and error.
std::string times_csv(const Report& report);

// Of reports with surfaces, every run with its seconds and its errors in the cell SS; empty for others.
std::string surface_table(const Report& report);

// Time to reach an error, of the beauty, by wall time.
std::string times_table(const Report& report);

}  // namespace brisance
