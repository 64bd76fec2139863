#include "shot/json_text.h"

#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <vector>

#include "core/error.h"

namespace brisance {
namespace {

// Counts lines as the parser reads on. The parser never looks beyond the key it reports, so the count is the key's
// line.
class LineCounter {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    LineCounter(const char* at, int* line) : at_(at), line_(line) {}
    reference operator*() const { return *at_; }
    LineCounter& operator++() {
        *line_ += *at_ == '\n' ? 1 : 0;
        ++at_;
        return *this;
    }
    LineCounter operator++(int) {
        LineCounter before = *this;
        ++*this;
        return before;
    }
    bool operator==(const LineCounter& other) const { return at_ == other.at_; }
    bool operator!=(const LineCounter& other) const { return at_ != other.at_; }

private:
    const char* at_;
    int* line_;
};

// Follows the parser through objects and notes where each key stands.
class KeyLines {
public:
    KeyLines(const std::string& source, const int& line, std::map<std::string, int>& line_of_key)
        : source_(source), line_(line), line_of_key_(line_of_key) {}

    bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
        using Event = Json::parse_event_t;
        if (event == Event::array_start || event == Event::array_end)
            arrays_ += event == Event::array_start ? 1 : -1;
        if (event == Event::key && arrays_ == 0)
            note(static_cast<std::size_t>(depth), parsed.get<std::string>());
        return true;
    }

private:
    void note(std::size_t depth, const std::string& key) {
        path_.resize(depth);
        path_.back() = key;
        const std::string dotted = fmt::format("{}", fmt::join(path_, "."));
        const auto [entry, first] = line_of_key_.emplace(dotted, line_);
        if (!first)
            throw Error(ExitCode::Usage, fmt::format("{}:{}: {} is given twice; it was given first on line {}", source_,
                                                     line_, dotted, entry->second));
    }

    const std::string& source_;
    const int& line_;
    std::map<std::string, int>& line_of_key_;
    std::vector<std::string> path_;
    int arrays_ = 0;
};

// The library's message without its own name and position.
std::string syntax_message(const std::string& what) {
    const std::size_t column = what.find("column ");
    const std::size_t begin = column == std::string::npos ? what.find("] ") : what.find(": ", column);
    return begin == std::string::npos ? what : what.substr(begin + 2);
}

}  // namespace

JsonText parse_json_text(const std::string& text, const std::string& source) {
    JsonText result;
    int line = 1;
    const char* const end = text.data() + text.size();
    try {
        result.value = Json::parse(LineCounter(text.data(), &line), LineCounter(end, &line),
                                   KeyLines(source, line, result.line_of_key), true, true);
    } catch (const Json::exception& error) {
        throw Error(ExitCode::Usage, fmt::format("{}:{}: {}", source, line, syntax_message(error.what())));
    }
    return result;
}

}  // namespace brisance
