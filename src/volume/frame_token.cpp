#include "volume/frame_token.h"

#include <fmt/format.h>

#include <cctype>
#include <regex>

namespace brisance {
namespace {

constexpr int kMostDigits = 16;

std::optional<FrameToken> token_at(const std::string& part, std::size_t at, bool file_name) {
    const auto digit = [&](std::size_t i) {
        return i < part.size() && std::isdigit(static_cast<unsigned char>(part[i]));
    };
    const auto number = [&](std::size_t& i) {
        int value = 0;
        for (; digit(i) && value <= kMostDigits; ++i)
            value = value * 10 + (part[i] - '0');
        return value;
    };
    std::size_t i = at + 1;
    if (part[at] == '#' || part[at] == '@') {
        while (i < part.size() && part[i] == part[at])
            ++i;
        const bool lone = i - at < 2 && !file_name;
        return lone ? std::nullopt : std::optional<FrameToken>({at, i, static_cast<int>(i - at)});
    }
    if (part[at] == '%') {  // %d, %04d; %4d pads with blanks, which no file name means
        const bool zero = i < part.size() && part[i] == '0';
        const std::size_t first = i;
        const int width = number(i);
        if (i < part.size() && part[i] == 'd' && width <= kMostDigits && (zero || i == first))
            return FrameToken{at, i + 1, width};
        return std::nullopt;
    }
    if (part[at] == '$' && i < part.size() && part[i] == 'F') {
        ++i;
        const int width = digit(i) ? part[i++] - '0' : 0;  // $F4: one digit
        const bool longer = i < part.size() && (std::isalpha(static_cast<unsigned char>(part[i])) || part[i] == '_');
        return longer && width == 0 ? std::nullopt : std::optional<FrameToken>({at, i, width});
    }
    if (part.compare(at, 6, "<frame") == 0) {
        i = at + 6;
        const int width = number(i);
        if (i < part.size() && part[i] == '>' && width <= kMostDigits)
            return FrameToken{at, i + 1, width};
    }
    return std::nullopt;
}

}  // namespace

std::optional<FrameToken> find_frame_token(const std::string& part, std::size_t from, bool file_name) {
    for (std::size_t at = from; at < part.size(); ++at)
        if (const std::optional<FrameToken> token = token_at(part, at, file_name))
            return token;
    return std::nullopt;
}

std::string expand_tokens(const std::string& part, int frame, bool file_name) {
    std::string result;
    std::size_t at = 0;
    while (const std::optional<FrameToken> token = find_frame_token(part, at, file_name)) {
        result += part.substr(at, token->begin - at);
        result += fmt::format("{:0{}d}", frame, token->width);
        at = token->end;
    }
    return result + part.substr(at);
}

std::string unknown_token(const std::string& path) {
    static const std::regex suspicious(R"(\$\{?[A-Za-z_]\w*\}?|%[-+ ]?\d+[dif]|%[if]\b|<[A-Za-z_]\w*>)");
    std::smatch match;
    return std::regex_search(path, match, suspicious) ? match.str() : std::string();
}

}  // namespace brisance
