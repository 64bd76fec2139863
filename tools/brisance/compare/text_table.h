// Tables for a terminal.
#pragma once

#include <string>
#include <vector>

namespace brisance {

// Columns as wide as their widest cell: the first `word_columns` are aligned left, numbers right. Rows of one length;
// at least one.
std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t word_columns);

}  // namespace brisance
