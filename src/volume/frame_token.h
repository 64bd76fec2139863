// The signs that stand for a frame number inside one part of a path.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace brisance {

struct FrameToken {
    std::size_t begin = 0;
    std::size_t end = 0;  // one past
    int width = 0;        // least number of digits
};

// The first token of `part` at or after `from`. In a folder's name (`file_name` false) a single # or @ is none.
std::optional<FrameToken> find_frame_token(const std::string& part, std::size_t from, bool file_name);

// Replaces every token of `part` by the frame. As with printf, a minus sign takes one character of the width.
std::string expand_tokens(const std::string& part, int frame, bool file_name);

// The first thing in an expanded path that looks like a token or a variable; empty when nothing does.
std::string unknown_token(const std::string& path);

}  // namespace brisance
