// The options of `brisance report`.
#pragma once

#include <CLI/CLI.hpp>

#include "report/report_command.h"

namespace brisance {

void add_report_options(CLI::App& command, ReportOptions& options);

// Methods on one shot, or on those of a suite.
int report_on(ReportOptions options);

}  // namespace brisance
