#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <unordered_set>

#include "core/error.h"
#include "volume/frame_path.h"

namespace brisance {
namespace {

constexpr std::size_t kLongestItem = 64;
constexpr std::size_t kMostFrames = 1'000'000;  // more must be a typing mistake

[[noreturn]] void reject(const std::string& list, const std::string& why) {
    throw Error(ExitCode::Usage, fmt::format("frames \"{}\": {}", list, why));
}

int number(const std::string& text, const std::string& list) {
    try {
        return std::stoi(text);
    } catch (const std::out_of_range&) {
        reject(list, text + " is too large");
    }
}

}  // namespace

std::vector<int> parse_frames(const std::string& list) {
    if (list.find(':') != std::string::npos)
        reject(list, "':' means a step to some schedulers and interleaving to others; write a step as 1001-1100x2");
    static const std::regex item_form(R"(\s*(-?\d+)\s*(?:(?:-|\.\.)\s*(-?\d+)\s*(?:x(\d+)\s*)?)?)");
    std::vector<int> frames;
    std::unordered_set<int> seen;
    std::istringstream items(list + ",");
    for (std::string item; std::getline(items, item, ',');) {
        // The standard library follows an expression by recursion.
        if (item.size() > kLongestItem)
            reject(list.substr(0, kLongestItem) + "...", "a number has at most ten digits");
        std::smatch match;
        if (!std::regex_match(item, match, item_form))
            reject(list, fmt::format("cannot read \"{}\"; write whole frames like 1001-1100x2,1200 or 1..10", item));
        const int first = number(match[1], list);
        const int last = match[2].matched ? number(match[2], list) : first;
        const int step = match[3].matched ? number(match[3], list) : 1;
        if (last < first)
            reject(list, fmt::format("{}-{} runs backwards; write {}-{}", first, last, last, first));
        if (step < 1)
            reject(list, "a step must be at least 1");
        for (long long frame = first; frame <= last; frame += step) {
            if (frames.size() >= kMostFrames)
                reject(list, fmt::format("more than {} frames", kMostFrames));
            if (seen.insert(static_cast<int>(frame)).second)
                frames.push_back(static_cast<int>(frame));
        }
    }
    return frames;
}

}  // namespace brisance
