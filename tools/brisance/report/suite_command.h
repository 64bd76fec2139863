// `brisance report --suite`: all methods on a list of scenes.
#pragma once

#include "report_command.h"

namespace brisance {

// Prints who is best and the paths of the files. A scene that fails is a row of the result. Throws Error: Usage,
// MissingInput (no folder of shots), and where every scene failed. Nothing is written before all is measured.
int run_suite(const ReportOptions& options);

}  // namespace brisance
