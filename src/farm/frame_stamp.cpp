#include "farm/frame_stamp.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "core/content_hash.h"
#include "core/printable.h"
#include "farm/input_files.h"
#include "shot/write_shot.h"

namespace brisance {

namespace {

using Stamp = nlohmann::ordered_json;

// The first file that differs.
std::string file_difference(const Stamp& found, const Stamp& wanted) {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (i >= found.size() || found[i].at("file") != wanted[i].at("file"))
            return fmt::format("it was made without {}", wanted[i].at("file").get<std::string>());
        if (found[i].at("hash") != wanted[i].at("hash"))
            return fmt::format("{} has other contents now", wanted[i].at("file").get<std::string>());
    }
    return "it was made of more files";
}

std::string difference(const Stamp& found, const Stamp& wanted) {
    if (found.at("version") != wanted.at("version"))
        return fmt::format("it is by version {}", printable(found.at("version").get<std::string>(), kLongestName));
    if (found.at("frame") != wanted.at("frame"))
        return fmt::format("it is frame {}", found.at("frame").get<int>());
    if (found.at("settings") != wanted.at("settings"))
        return "it has other settings";
    return file_difference(found.at("files"), wanted.at("files"));
}

}  // namespace

FrameStamps::FrameStamps(const Shot& shot, std::string version, const std::vector<std::filesystem::path>& deciding)
    : shot_(shot), version_(std::move(version)), settings_(settings_hash(shot)), deciding_(deciding) {}

const std::string& FrameStamps::hash_of_file(const std::filesystem::path& file) {
    const auto known = hashes_.find(file);
    return known != hashes_.end() ? known->second : hashes_[file] = content_hash_of_file(file);
}

std::string FrameStamps::of(const FrameFile& frame) {
    Stamp stamp = {{"version", version_}, {"settings", settings_}, {"frame", frame.frame}, {"files", Stamp::array()}};
    std::vector<std::filesystem::path> files = volume_files(shot_, frame);
    if (!set_)
        set_ = set_files(shot_);
    files.insert(files.end(), set_->begin(), set_->end());
    files.insert(files.end(), deciding_.begin(), deciding_.end());
    for (const std::filesystem::path& file : files)
        stamp["files"].push_back({{"file", file.filename().string()}, {"hash", hash_of_file(file)}});
    return stamp.dump(-1, ' ', false, Stamp::error_handler_t::replace);
}

std::string FrameStamps::hash_of(const std::string& stamp) {
    return content_hash(stamp);
}

std::optional<std::string> stamp_difference(const std::string& found, const std::string& wanted) {
    if (found == wanted)
        return std::nullopt;
    try {
        return difference(Stamp::parse(found), Stamp::parse(wanted));
    } catch (const nlohmann::json::exception&) {
        return "what it says of its inputs is damaged";
    }
}

}  // namespace brisance
