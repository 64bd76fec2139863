#include "compare/text_table.h"

#include <algorithm>

namespace brisance {
namespace {

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

}  // namespace

std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t word_columns) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c)
            widths[c] = std::max(widths[c], row[c].size());
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const std::string gap(c == 0 ? 0 : 2, ' ');
            line += gap + (c < word_columns ? padded(row[c], widths[c])
                                            : std::string(widths[c] - row[c].size(), ' ') + row[c]);
        }
        text += line + "\n";
    }
    return text;
}

}  // namespace brisance
