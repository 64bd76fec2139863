#include "finished_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.h"
#include "farm/frame_stamp.h"
#include "film/write_image.h"
#include "shot/scene_differences.h"
#include "shot/write_shot.h"

namespace brisance {

namespace {

constexpr const char* kCertificateKey = "brisance/certificate";
constexpr std::size_t kMostKeysNamed = 3;

using Why = std::optional<std::string>;

// The keys that differ, where the stored shot tells.
std::string named_differences(const std::string& stored, const Shot& shot) {
    std::vector<std::string> lines;
    try {
        lines = setting_differences(stored, to_json(shot));
    } catch (const Error&) {
        return "";
    }
    std::string text;
    for (std::size_t i = 0; i < std::min(lines.size(), kMostKeysNamed); ++i)
        text += (i == 0 ? ": " : ", ") + lines[i];
    return lines.size() > kMostKeysNamed ? fmt::format("{} and {} more", text, lines.size() - kMostKeysNamed) : text;
}

Why why_not_this_frame(const ExrMetadata& found, const Shot& shot, const std::string& stamp) {
    const auto stored = found.text.find(kStampKey);
    if (stored == found.text.end())
        return "its header does not say what it was made of";
    if (Why why = stamp_difference(stored->second, stamp)) {
        const auto settings = found.text.find("brisance/shot");
        if (settings != found.text.end() && why->ends_with("settings"))
            *why += named_differences(settings->second, shot);
        return why;
    }
    if (shot.certify.enabled && !found.text.contains(kCertificateKey) && !found.text.contains("brisance/half"))
        return "it has no certificate";
    return std::nullopt;
}

Why why_no_exr(const std::filesystem::path& file, const Shot& shot, const std::string& stamp) {
    try {
        if (const Why why = why_not_this_frame(read_exr_metadata(file), shot, stamp))
            return fmt::format("{}: {}", file.string(), *why);
        const Image image = read_exr(file);
        if (image.width != shot.camera.width || image.height != shot.camera.height)
            return fmt::format("{}: it has {} x {} pixels", file.string(), image.width, image.height);
    } catch (const Error& error) {
        return error.what();  // which names the file
    }
    return std::nullopt;
}

// By its last chunk: a PNG that was cut off lacks it.
bool is_whole_png(const std::filesystem::path& file) {
    constexpr std::array<char, 8> last = {'I', 'E', 'N', 'D', '\xae', 'B', '`', '\x82'};
    std::ifstream in(file, std::ios::binary);
    std::array<char, 8> end{};
    in.seekg(-8, std::ios::end);
    in.read(end.data(), end.size());
    return in && end == last;
}

bool is_json(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return nlohmann::json::accept(in);
}

}  // namespace

std::optional<std::string> why_unfinished(const FrameOutput& output, const Shot& shot, const std::string& stamp) {
    std::error_code error;
    const auto absent = [&](const std::filesystem::path& file) {
        return !file.empty() && !std::filesystem::exists(file, error);
    };
    if (absent(output.exr))
        return kNotThere;
    for (const std::filesystem::path& file : {output.exr, output.halves[0], output.halves[1]}) {
        if (absent(file) && shot.method == RenderMethod::Path)
            return fmt::format("{} is not there", file.string());
        if (!file.empty() && !absent(file))
            if (Why why = why_no_exr(file, shot, stamp))
                return why;
    }
    for (const std::filesystem::path& file : {output.png, output.statistics})
        if (absent(file))
            return fmt::format("{} is not there", file.string());
    if (!output.png.empty() && !is_whole_png(output.png))
        return fmt::format("{} is damaged", output.png.string());
    if (!output.statistics.empty() && !is_json(output.statistics))
        return fmt::format("{} is damaged", output.statistics.string());
    return std::nullopt;
}

}  // namespace brisance
