#include "shot/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "core/error.h"
#include "core/printable.h"

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

constexpr int kDeepest = 256;              // JSON is copied and written by recursion
constexpr std::size_t kMostKeys = 10000;   // JSON keeps the order of keys, and seeks each among all before it
constexpr std::size_t kLongestPath = 200;  // no key of a shot has a longer one

// Follows the parser through objects and lists, and notes where each key stands.
class KeyLines {
public:
    KeyLines(const std::string& source, const int& line, std::map<std::string, int>& line_of_key)
        : source_(source), line_(line), line_of_key_(line_of_key) {}

    bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
        using Event = Json::parse_event_t;
        if (event == Event::object_start || event == Event::array_start) {
            if (depth >= kDeepest)
                throw Error(ExitCode::Usage, fmt::format("{}:{}: nested more than {} levels deep; a shot needs six",
                                                         source_, line_, kDeepest));
            levels_.push_back({event == Event::array_start, path_.size(), {}});
        } else if (event == Event::object_end || event == Event::array_end) {
            path_.resize(levels_.back().path_begin);
            levels_.pop_back();
        } else if (event == Event::key) {
            note(parsed.get_ref<const std::string&>());
        }
        return true;
    }

private:
    struct Level {
        bool is_list;
        std::size_t path_begin;  // length of the path that leads here
        std::map<std::string, int> line_of;
    };

    void note(const std::string& key) {
        Level& level = levels_.back();
        if (level.line_of.size() >= kMostKeys)
            throw Error(ExitCode::Usage, fmt::format("{}:{}: more than {} keys in one object; a shot needs hundreds",
                                                     source_, line_, kMostKeys));
        path_.resize(level.path_begin);
        if (path_.size() <= kLongestPath)
            path_.append(path_.empty() ? "" : ".").append(key, 0, kLongestPath);
        const auto [entry, first] = level.line_of.emplace(key, line_);
        if (!first)
            throw Error(ExitCode::Usage, fmt::format("{}:{}: {} is given twice; it was given first on line {}", source_,
                                                     line_, printable(path_), entry->second));
        const bool in_list = std::any_of(levels_.begin(), levels_.end(), [](const Level& l) { return l.is_list; });
        if (!in_list && path_.size() <= kLongestPath)
            line_of_key_.emplace(path_, line_);
    }

    const std::string& source_;
    const int& line_;
    std::map<std::string, int>& line_of_key_;
    std::string path_;
    std::vector<Level> levels_;
};

// The library's message without its own name and position.
std::string syntax_message(const std::string& what) {
    const std::size_t column = what.find("column ");
    const std::size_t begin = column == std::string::npos ? what.find("] ") : what.find(": ", column);
    return begin == std::string::npos ? what : what.substr(begin + 2);
}

}  // namespace

std::optional<Json> parse_json_value(const std::string& text) {
    std::size_t keys = 0;
    const auto shallow = [&](int depth, Json::parse_event_t event, const Json&) {
        keys += event == Json::parse_event_t::key ? 1 : 0;
        if (depth > kDeepest || keys > kMostKeys)
            throw std::length_error("nested too deeply, or too many keys");
        return true;
    };
    try {
        Json value = Json::parse(text, shallow, false);
        return value.is_discarded() ? std::nullopt : std::optional(std::move(value));
    } catch (const std::length_error&) {
        return std::nullopt;
    }
}

JsonText parse_json_text(const std::string& text, const std::string& source) {
    JsonText result;
    int line = 1;
    const char* const end = text.data() + text.size();
    try {
        result.value = Json::parse(LineCounter(text.data(), &line), LineCounter(end, &line),
                                   KeyLines(source, line, result.line_of_key), true, true);
    } catch (const Json::exception& error) {
        throw Error(ExitCode::Usage, fmt::format("{}:{}: {}", source, line, printable(syntax_message(error.what()))));
    }
    return result;
}

Json& at_path(Json& root, const std::string& path) {
    Json* node = &root;
    std::size_t begin = 0;
    for (std::size_t point = path.find('.'); point != std::string::npos; point = path.find('.', begin)) {
        node = &(*node)[path.substr(begin, point - begin)];
        begin = point + 1;
    }
    return (*node)[path.substr(begin)];
}

}  // namespace brisance
