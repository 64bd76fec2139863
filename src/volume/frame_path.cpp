#include "volume/frame_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/error.h"
#include "volume/frame_token.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

bool is_folder_part(const std::string& pattern, std::size_t position) {
    return pattern.find('/', position) != std::string::npos;
}

// Digits at the end of the file name's stem, as [begin, end) within the whole path; a point may follow them only as the
// beginning of the extension.
std::optional<std::pair<std::size_t, std::size_t>> number_range(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    const std::size_t name = slash == std::string::npos ? 0 : slash + 1;
    const std::size_t point = path.rfind('.');
    std::size_t end = point == std::string::npos || point <= name ? path.size() : point;
    const auto digit = [&](std::size_t i) { return std::isdigit(static_cast<unsigned char>(path[i])) != 0; };
    while (end > name && !digit(end - 1))
        --end;
    std::size_t begin = end;
    while (begin > name && digit(begin - 1))
        --begin;
    if (begin == end)
        return std::nullopt;
    return std::pair{begin, end};
}

std::optional<int> to_int(std::string_view text) {
    int value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || rest != text.data() + text.size())
        return std::nullopt;
    return value;
}

// The frame for which `part` of a pattern becomes `name`. `exact`: padding must be right as well.
std::optional<int> frame_for_name(const std::string& part, bool file_name, const std::string& name, bool exact) {
    const std::optional<FrameToken> token = find_frame_token(part, 0, file_name);
    if (!token || name.compare(0, token->begin, part, 0, token->begin) != 0)
        return std::nullopt;
    std::size_t end = token->begin;
    if (end < name.size() && name[end] == '-')
        ++end;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0)
        ++end;
    const std::optional<int> frame = to_int(std::string_view(name).substr(token->begin, end - token->begin));
    if (!frame)
        return std::nullopt;
    const bool same = exact ? expand_tokens(part, *frame, file_name) == name
                            : name.compare(end, std::string::npos, part, token->end, std::string::npos) == 0;
    return same ? frame : std::nullopt;
}

struct Found {
    int frame;
    fs::path path;
};

// Walks the components of a pattern; a component with tokens fixes the frame, later ones must agree with it.
void collect(const fs::path& so_far, const std::vector<std::string>& parts, std::size_t at, std::optional<int> frame,
             bool exact, std::vector<Found>& found) {
    std::error_code error;
    if (at == parts.size()) {
        if (frame && fs::is_regular_file(so_far, error))
            found.push_back({*frame, so_far});
        return;
    }
    const bool file_name = at + 1 == parts.size();
    if (!find_frame_token(parts[at], 0, file_name)) {
        collect(so_far / parts[at], parts, at + 1, frame, exact, found);
        return;
    }
    if (frame) {
        collect(so_far / expand_tokens(parts[at], *frame, file_name), parts, at + 1, frame, exact, found);
        return;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(so_far.empty() ? "." : so_far, error)) {
        const std::string name = entry.path().filename().string();
        if (const std::optional<int> here = frame_for_name(parts[at], file_name, name, exact))
            collect(so_far / name, parts, at + 1, here, exact, found);
    }
}

std::vector<Found> find_frames(const std::string& pattern, bool exact) {
    std::vector<std::string> parts;
    for (const fs::path& part : fs::path(pattern))
        parts.push_back(part.string());
    std::vector<Found> found;
    collect({}, parts, 0, std::nullopt, exact, found);
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.frame < b.frame; });
    return found;
}

[[noreturn]] void throw_missing(const std::string& pattern, const fs::path& path, int frame) {
    std::string there;
    const std::vector<int> frames = has_frame_token(pattern) ? frames_on_disk(pattern) : std::vector<int>();
    std::error_code error;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!frames.empty()) {
        there = fmt::format("frames {} exist", describe_frames(frames));
    } else if (!fs::is_directory(folder, error)) {
        there = fmt::format("the folder {} does not exist", folder.string());
    } else if (const std::vector<Found> loose = find_frames(pattern, false); !loose.empty()) {
        const std::string example = loose.front().path.filename().string();
        there = fmt::format("other padding exists: {}; write {}", example, pattern_of(example).value_or(example));
    } else {
        there = "no frame of this name exists";
    }
    throw Error(ExitCode::MissingInput, fmt::format("frame {} is missing: {}; {}", frame, path.string(), there));
}

}  // namespace

bool has_frame_token(const std::string& pattern) {
    for (std::size_t at = 0; at < pattern.size();) {
        const std::size_t slash = std::min(pattern.find('/', at), pattern.size());
        if (find_frame_token(pattern.substr(at, slash - at), 0, !is_folder_part(pattern, at)))
            return true;
        at = slash + 1;
    }
    return false;
}

std::string expand(const std::string& pattern, int frame) {
    constexpr std::size_t longest = 4096;  // of a path of the system
    if (pattern.size() > longest)
        throw Error(ExitCode::Usage, fmt::format("{}...: a path has at most {} characters, this has {}",
                                                 pattern.substr(0, 60), longest, pattern.size()));
    std::string result;
    for (std::size_t at = 0; at <= pattern.size();) {
        const std::size_t slash = std::min(pattern.find('/', at), pattern.size());
        const bool folder = slash < pattern.size();
        result += expand_tokens(pattern.substr(at, slash - at), frame, !folder);
        if (folder)
            result += '/';
        at = slash + 1;
    }
    if (const std::string left = unknown_token(result); !left.empty())
        throw Error(ExitCode::Usage,
                    fmt::format("{}: \"{}\" is not expanded; frame tokens are ####, @@@, %04d, $F4, $F and "
                                "<frame04>, other variables must be replaced by their values",
                                pattern, left));
    return result;
}

std::string describe_frames(const std::vector<int>& frames) {
    constexpr std::size_t most = 12;
    std::string text;
    std::size_t ranges = 0;
    for (std::size_t i = 0; i < frames.size(); ++ranges) {
        std::size_t last = i;
        while (last + 1 < frames.size() && frames[last + 1] == frames[last] + 1)
            ++last;
        if (ranges == most)
            return text + fmt::format(", ... {} ({} frames)", frames.back(), frames.size());
        const char* const comma = text.empty() ? "" : ", ";
        text +=
            last == i ? fmt::format("{}{}", comma, frames[i]) : fmt::format("{}{}-{}", comma, frames[i], frames[last]);
        i = last + 1;
    }
    return text;
}

std::optional<int> frame_number_of(const std::filesystem::path& file) {
    const std::string path = file.string();
    const auto range = number_range(path);
    return range ? to_int(std::string_view(path).substr(range->first, range->second - range->first)) : std::nullopt;
}

std::optional<std::string> pattern_of(const std::filesystem::path& file) {
    std::string path = file.string();
    const auto range = number_range(path);
    if (!range)
        return std::nullopt;
    const std::size_t digits = range->second - range->first;
    const bool padded = digits > 1 && (path[range->first] == '0' || digits >= 4);
    return path.replace(range->first, digits, padded ? std::string(digits, '#') : "#");
}

std::vector<int> frames_on_disk(const std::string& pattern) {
    std::vector<int> frames;
    for (const Found& found : find_frames(pattern, true))
        if (frames.empty() || frames.back() != found.frame)
            frames.push_back(found.frame);
    return frames;
}

std::filesystem::path resolve_frame(const std::string& pattern, int frame) {
    fs::path path = expand(pattern, frame);
    std::error_code error;
    if (!fs::exists(path, error))
        throw_missing(pattern, path, frame);
    return path;
}

std::vector<FrameFile> resolve_sequence(const std::string& pattern, const std::optional<std::vector<int>>& frames) {
    if (!has_frame_token(pattern)) {
        const std::optional<int> number = frame_number_of(pattern);
        if (number && frames && frames->size() > 1)
            throw Error(
                ExitCode::Usage,
                fmt::format("{} is one file for one frame, but {} frames were requested; write {} for the sequence",
                            pattern, frames->size(), pattern_of(pattern).value_or(pattern)));
        std::vector<FrameFile> files;
        for (const int frame : frames.value_or(std::vector<int>{number.value_or(1)}))
            files.push_back({frame, resolve_frame(pattern, frame)});
        return files;
    }
    const std::vector<int> wanted = frames ? *frames : frames_on_disk(pattern);
    if (wanted.empty())
        throw_missing(pattern, expand(pattern, 1), 1);
    std::vector<FrameFile> files;
    files.reserve(wanted.size());
    for (const int frame : wanted)
        files.push_back({frame, resolve_frame(pattern, frame)});
    return files;
}

}  // namespace brisance
