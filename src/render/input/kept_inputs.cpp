#include "render/input/kept_inputs.h"

#include <algorithm>

#include "core/available_memory.h"
#include "core/error.h"
#include "forecast/memory_need.h"
#include "render/input/load_medium.h"
#include "render/input/volume_in_time.h"

namespace brisance {

namespace {

constexpr std::uint64_t kNextGridMemory = std::uint64_t{16} << 30;
constexpr std::uint64_t kCopies = 2;  // the tree in the child process, and the blocks in this one

// Whether every frame reads the file of its own number.
bool plain_times(const Shot& shot) {
    return shot.time.identity() && std::all_of(shot.volumes.begin(), shot.volumes.end(),
                                               [&](const FurtherVolume& v) { return time_of(shot, v).identity(); });
}

// The files of the next frame, in the order of the volumes, with the grids that this frame took of them. Times between
// files are not read ahead.
std::vector<FileToRead> next_files(const Shot& shot, const KeptInputs& kept) {
    if (!plain_times(shot))
        return {};
    std::vector<std::filesystem::path> files;
    if (!kept.next->file.empty())
        files.push_back(kept.next->file);
    for (const std::filesystem::path& file : further_files(shot, kept.next->frame))
        files.push_back(file);
    std::vector<FileToRead> wanted;
    for (std::size_t i = 0; i < std::min(files.size(), kept.grids.size()); ++i)
        if (!files[i].empty() && !kept.grids[i].empty())
            wanted.push_back({files[i], kept.grids[i]});
    return wanted;
}

// Grids grow with their files.
std::uint64_t bytes_to_read(const std::vector<FileToRead>& files, const KeptInputs& kept) {
    std::uint64_t bytes = 0;
    for (const FileToRead& file : files) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(file.file, error);
        bytes += error ? 0 : size;
    }
    const double growth = kept.bytes_of_files > 0 ? std::max(1.0, double(bytes) / double(kept.bytes_of_files)) : 1.0;
    return static_cast<std::uint64_t>(double(kCopies * kept.bytes_read) * growth);
}

}  // namespace

void SaidLines::notice(const std::string& line) {
    lines.emplace_back("", line);
    to_.notice(line);
}

void SaidLines::warning(const std::string& code, const std::string& line) {
    lines.emplace_back(code, line);
    to_.warning(code, line);
}

void say_again(const std::vector<std::pair<std::string, std::string>>& lines, Progress& progress) {
    for (const auto& [code, line] : lines)
        code.empty() ? progress.notice(line) : progress.warning(code, line);
}

bool memory_allows(std::optional<std::uint64_t> available, std::uint64_t lighting, std::uint64_t reading) {
    return available && lighting <= *available && reading <= *available - lighting;
}

void read_next_frame(const Shot& shot, const Medium& medium, KeptInputs& kept) {
    if (!kept.next)
        return;
    try {
        const std::vector<FileToRead> files = next_files(shot, kept);
        const std::uint64_t lighting = bytes_to_light(medium, true, shot.lighting.memory_limit_bytes);
        if (!files.empty() && memory_allows(available_memory(), lighting, bytes_to_read(files, kept)))
            kept.volumes.begin(files, kNextGridMemory);
    } catch (const Error&) {
        return;  // the next frame will say so
    }
}

}  // namespace brisance
