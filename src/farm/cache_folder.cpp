#include "farm/cache_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/content_hash.h"
#include "core/error.h"
#include "film/whole_file.h"

namespace brisance {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "brisance cache 1\n";
constexpr const char* kExtension = ".result";
constexpr double kFilledAgain = 0.9;  // of the limit: how much is left when room is made

// "MAGIC key-length value-length checksum\n" key value
std::string packed(std::string_view key, std::string_view value) {
    const std::string body = std::string(key) + std::string(value);
    return fmt::format("{}{} {} {}\n{}", kMagic, key.size(), value.size(), content_hash(body), body);
}

struct Unpacked {
    std::string key, value;
};

// Nothing where the bytes are not what packed() made.
std::optional<Unpacked> unpacked(std::string_view bytes) {
    if (!bytes.starts_with(kMagic))
        return std::nullopt;
    bytes.remove_prefix(kMagic.size());
    const std::size_t end = bytes.find('\n');
    if (end == std::string_view::npos)
        return std::nullopt;
    unsigned long long key = 0, value = 0;
    char checksum[17] = {};
    if (std::sscanf(std::string(bytes.substr(0, end)).c_str(), "%llu %llu %16s", &key, &value, checksum) != 3)
        return std::nullopt;
    const std::string_view body = bytes.substr(end + 1);
    if (key > body.size() || value != body.size() - key || content_hash(body) != checksum)
        return std::nullopt;
    return Unpacked{std::string(body.substr(0, key)), std::string(body.substr(key))};
}

std::optional<std::string> bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in)
        return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(in), {});
}

struct Result {
    fs::path file;
    std::uint64_t bytes;
    fs::file_time_type used;
};

// Those that other processes remove meanwhile are left out.
std::vector<Result> results_in(const fs::path& folder) {
    std::vector<Result> results;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        std::error_code gone;
        const bool whole = at->path().extension() == kExtension && !at->path().filename().string().starts_with('.');
        const std::uint64_t bytes = whole ? at->file_size(gone) : 0;
        const fs::file_time_type used = at->last_write_time(gone);
        if (!gone && bytes > 0)
            results.push_back({at->path(), bytes, used});
    }
    return results;
}

}  // namespace

CacheFolder::CacheFolder(fs::path folder, std::uint64_t most_bytes, Progress& progress)
    : folder_(std::move(folder)), most_bytes_(most_bytes), progress_(progress) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (!fs::is_directory(folder_, error))
        throw Error(ExitCode::CannotCreate,
                    fmt::format("--cache {}: it is no folder and cannot be made one; name another", folder_.string()));
    check_writable(folder_ / fmt::format("{:016x}{}", 0, kExtension));
}

fs::path CacheFolder::file_of(std::string_view key) const {
    return folder_ / (content_hash(key) + kExtension);
}

std::optional<std::string> CacheFolder::find(std::string_view key) {
    const fs::path file = file_of(key);
    const std::optional<std::string> bytes = bytes_of(file);
    if (!bytes)
        return std::nullopt;
    std::optional<Unpacked> result = unpacked(*bytes);
    std::error_code error;
    if (!result) {
        progress_.warning("cache",
                          fmt::format("{} is damaged: it is removed, and what it held is made anew", file.string()));
        fs::remove(file, error);
        return std::nullopt;
    }
    if (result->key != key)
        return std::nullopt;  // another one with the same hash
    fs::last_write_time(file, fs::file_time_type::clock::now(), error);
    ++found_;
    return std::move(result->value);
}

void CacheFolder::keep(std::string_view key, std::string_view value) {
    if (full_)
        return;
    const fs::path file = file_of(key);
    remove_leftovers(file);
    try {
        write_whole_file(file, packed(key, value));
        ++kept_;
        make_room();
    } catch (const Error& error) {
        full_ = true;
        progress_.warning("cache", fmt::format("nothing more is kept in {}: {}", folder_.string(), error.what()));
    }
}

void CacheFolder::make_room() {
    std::vector<Result> results = results_in(folder_);
    std::uint64_t bytes = 0;
    for (const Result& result : results)
        bytes += result.bytes;
    if (bytes <= most_bytes_)
        return;
    std::ranges::sort(results, {}, &Result::used);
    for (const Result& oldest : results) {
        if (double(bytes) <= kFilledAgain * double(most_bytes_))
            break;
        std::error_code error;
        fs::remove(oldest.file, error);
        bytes -= oldest.bytes;
    }
}

}  // namespace brisance
