// Results as text, as Markdown, and as JSON.
#pragma once

#include <string>
#include <vector>

#include "stability/run_cases.h"

namespace brisance::stability {

// One line per result, under table_head().
std::string table_head();
std::string table_line(const Result& result);

// The whole table in Markdown, followed by each case's truth and the reason for its tolerance.
std::string markdown_table(const std::vector<Case>& cases, const std::vector<Result>& results);

std::string results_json(const std::vector<Case>& cases, const std::vector<Result>& results);

}  // namespace brisance::stability
